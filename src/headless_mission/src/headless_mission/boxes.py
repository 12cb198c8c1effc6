"""Solid objects of a mission as boxes in an episode."""

from collections import deque
from typing import Deque, List

from add_markers import MissionBoxes, PlaceBox, SolidBox
from add_markers.boxes import HEIGHT, MASS, RIDING_HEIGHT
from headless_mission.errand import ErrandHooks
from pick_objects import Errand
from planar import OccupancyGrid, Pose2
from sim_bridge import Episode, EpisodeHooks, Simulation, StepResult
from sim_bridge.simulation import box_on_floor

# Control periods from a change of the mission to the box: that of the message to add_markers, and that of its
# service calls, which the simulator answers at the next instant (docs/explanation/deterministic_runs.md).
MESSAGE_AND_CALL = 2


class BoxHooks(EpisodeHooks):
    """Moves the boxes as the mission proceeds, as add_markers does over ROS.

    Args:
        simulation: Simulation with the robot.
        grid: Map in which boxes are placed.
        errand: The mission.
    """

    def __init__(self, simulation: Simulation, grid: OccupancyGrid, errand: ErrandHooks):
        self._simulator, self._errand = SceneBoxes(simulation), errand
        self._boxes = MissionBoxes(self._simulator)
        self._boxes.set_map(grid)
        self._sent: Deque[List[SolidBox]] = deque()

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        self._simulator.robot = step.base_in_world
        if self._errand.is_started:
            self._sent.append(boxes_of(self._errand.errand))
        if len(self._sent) > MESSAGE_AND_CALL:
            self._boxes.update(self._sent.popleft())


class SceneBoxes:
    """Boxes in a simulation (add_markers: BoxSimulator).

    Attributes:
        robot: True pose of the robot.
    """

    def __init__(self, simulation: Simulation):
        self._simulation, self.robot = simulation, Pose2()

    def robot_in_world(self) -> Pose2:
        return self.robot

    def remove(self, name: str) -> None:
        self._simulation.scene.remove_model(name)

    def spawn(self, order: PlaceBox) -> None:
        name, edge, scene = order.solid.name, order.solid.size, self._simulation.scene
        size = (edge, edge, HEIGHT)
        if order.pose is not None:
            scene.add([box_on_floor(name, size, order.pose, MASS)])
        else:
            scene.add([box_on_floor(name, size, self.robot, MASS, height=RIDING_HEIGHT)])
            scene.attach(self._simulation.base, f"{name}::link")


def boxes_of(errand: Errand) -> List[SolidBox]:
    """Return the solid objects of an errand and where they are now."""
    objects = [(errand.mission.object_named(name), where) for name, where in errand.object_locations.items()]
    return [
        SolidBox(item.name, item.size, None if where.is_carried else where.pose)
        for item, where in objects
        if item.solid
    ]
