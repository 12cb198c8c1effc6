"""A detector of objects: reports those that its camera sees, by its declared model (planar.detection)."""

from dataclasses import dataclass, replace
from typing import Sequence, Tuple

import numpy as np

from planar import Pose2
from planar.detection import Detection, DetectionModel, Detections
from planar.maps.semantic_map import PlacedObject
from sim_bridge.config import SimulationSettings
from sim_bridge.description import RobotProfile
from sim_bridge.geometry.pose3 import to_pose2
from sim_bridge.sensors.base import Mounting, Schedule, SensorContext, every

# Number of the stream of random numbers (see Mounting.rng).
STREAM = 300


@dataclass(frozen=True)
class ObjectDetectorProfile:
    """A camera on a mast with a detector.

    Attributes:
        objects: Where the objects truly are in the world.
        model: Model of the detector.
        topic: Topic of the detections.
        frame: Frame of the positions.
    """

    objects: Tuple[PlacedObject, ...]
    model: DetectionModel = DetectionModel()
    topic: str = "detected_objects"
    frame: str = "base_footprint"

    def build(self, mounting: Mounting) -> "ObjectDetector":
        return ObjectDetector(self, mounting.rng(STREAM))


class ObjectDetector:
    """Detects objects that nothing hides from the camera.

    Args:
        profile: Objects and model.
        rng: Random generator of missed detections and noise.
    """

    name, on_demand = "object_detector", False

    def __init__(self, profile: ObjectDetectorProfile, rng: np.random.Generator):
        self.frame, self._profile, self._rng = profile.frame, profile, rng

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(self._profile.model.rate, settings)

    def measure(self, context: SensorContext) -> Detections:
        base = to_pose2(context.base.pose)
        found = []
        for item in self._profile.objects:
            chance, noise = self._rng.random(), self._rng.normal(0.0, self._profile.model.position_noise, 2)
            at = base.inverse() @ item.pose
            ranges, bearings = np.hypot(at.x, at.y), np.arctan2(at.y, at.x)
            if chance >= self._profile.model.probability_at(ranges, bearings):
                continue
            if not self._is_hidden(item, base, context):
                x, y = (np.array([at.x, at.y]) + noise).tolist()
                found.append(Detection(item.name, x, y, item.z))
        return tuple(found)

    def _is_hidden(self, item: PlacedObject, base: Pose2, context: SensorContext) -> bool:
        """Return whether something is between camera and object."""
        camera = np.array([base.x, base.y, self._profile.model.height])
        ray = np.array([item.x, item.y, item.z]) - camera
        distance = float(np.linalg.norm(ray))
        lengths, _ = context.cast_rays(camera, (ray / distance)[None, :], distance)
        return bool(lengths[0] < distance - self._profile.model.depth)


def with_object_detector(robot: RobotProfile, objects: Sequence[PlacedObject]) -> RobotProfile:
    """Return a robot with a detector of objects; as it is if there are none.

    Args:
        robot: The robot.
        objects: Where objects truly are in the world.
    """
    if not objects:
        return robot
    return replace(robot, sensors=(*robot.sensors, ObjectDetectorProfile(tuple(objects))))
