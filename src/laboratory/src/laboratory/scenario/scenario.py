"""A scenario: world, robot, task, disturbances, planner, limits and seeds."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Mapping, Tuple, Union

from laboratory.scenario.digest import scenario_digest
from laboratory.tasks.task import Task
from laboratory.worlds.people import Pedestrians, with_people
from laboratory.worlds.source import Arena, WorldSource
from planar import Pose2
from sim_bridge import SimulationSettings
from sim_bridge.doorway import Door
from sim_bridge.faults import Fault

# Name of the planner that stands for the official move_base with its DWA planner, and of the localizer that
# stands for the official amcl; both only over ROS.
OFFICIAL = "official"


@dataclass(frozen=True)
class Scenario:
    """A scenario.

    Attributes:
        name: Name of the file without its suffix.
        file: Path of the scenario file.
        world: Source of its worlds.
        task: Task of the robot.
        about: Description in one sentence.
        robot: Name of the robot profile.
        start: Start pose in the world frame.
        simulation: Noise and rates of the simulation.
        boxes: Number of boxes that are not in the map.
        boxes_at: Poses of such boxes in the world frame.
        moves: How often one of the boxes is moved during a run.
        doors: Number of doors that close during a run, or these doors.
        people: Pedestrians.
        faults: Injected faults.
        planner: Local planner; empty: that of the robot.
        localizer: ``official`` for the official amcl; empty: amcl_lite.
        parameters: Parameters of move_base that override those of the robot.
        seconds: Maximum duration of a run [simulated s].
        seeds: Seeds of an evaluation.
        is_over_ros: Whether it runs as a graph of ROS nodes instead of in one process.
    """

    name: str
    file: Path
    world: WorldSource
    task: Task
    about: str = ""
    robot: str = "turtlebot_lidar"
    start: Pose2 = Pose2()
    simulation: SimulationSettings = SimulationSettings()
    boxes: int = 0
    boxes_at: Tuple[Pose2, ...] = ()
    moves: int = 0
    doors: Union[int, Tuple[Door, ...]] = 0
    people: Pedestrians = Pedestrians()
    faults: Tuple[Fault, ...] = ()
    planner: str = ""
    localizer: str = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    seconds: float = 600.0
    seeds: Tuple[int, ...] = tuple(range(100))
    is_over_ros: bool = False

    def with_planner(self, planner: str) -> "Scenario":
        """Return the same scenario with another local planner."""
        return replace(self, planner=planner)

    def with_parameters(self, parameters: Mapping[str, Any]) -> "Scenario":
        """Return the same scenario with other parameters of move_base."""
        return replace(self, parameters=parameters)

    @property
    def label(self) -> str:
        """Name with the planner, the localizer and the mode, if they are not the default."""
        parts = [self.planner, f"{self.localizer} amcl" if self.localizer else ""]
        parts = [part for part in parts if part]
        name = f"{self.name} [{', '.join(parts)}]" if parts else self.name
        return f"{name} over ROS" if self.is_over_ros else name

    def digest(self) -> str:
        """Return the digest of everything that influences a run: see ``scenario_digest``."""
        return scenario_digest(self)

    def arena(self, seed: int) -> Arena:
        """Return the world of a seed with its doors, boxes and pedestrians. Raises PlanarError."""
        from laboratory.worlds.boxes import with_boxes, with_boxes_at, with_moves
        from laboratory.worlds.doors import with_doors, with_doors_at

        arena = self.world.arena(seed)
        if isinstance(self.doors, tuple):
            arena = with_doors_at(arena, self.doors)
        elif self.doors:
            arena = with_doors(arena, self.doors, seed, (self.start, *self.task.required_poses(arena)))
        if self.boxes:
            arena = with_boxes(arena, self.boxes, seed, (self.start, *self.task.required_poses(arena)))
        if self.boxes_at:
            arena = with_boxes_at(arena, self.boxes_at)
        if self.moves:
            arena = with_moves(arena, self.moves, seed, self.seconds)
        if self.people.count:
            arena = with_people(arena, self.people, seed, self.start, self.task.required_poses(arena))
        return arena
