"""Objects in a world that a robot can detect: giving it the detector."""

from dataclasses import replace
from typing import Sequence

from planar.maps.semantic_map import PlacedObject
from sim_bridge.description import RobotProfile
from sim_bridge.sensors.object_detector import ObjectDetectorProfile


def with_object_detector(robot: RobotProfile, objects: Sequence[PlacedObject]) -> RobotProfile:
    """Return a robot with a detector of objects; as it is if there are none.

    Args:
        robot: The robot.
        objects: Where objects truly are in the world.
    """
    if not objects:
        return robot
    return replace(robot, sensors=(*robot.sensors, ObjectDetectorProfile(tuple(objects))))
