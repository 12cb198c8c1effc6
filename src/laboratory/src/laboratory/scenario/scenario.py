"""What is played: a world, a robot in it, a task, what happens meanwhile, who plans, limits, seeds."""

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

# A planner that is none of ours: the node of the official package move_base with its DWA, over ROS.
OFFICIAL = "official"


@dataclass(frozen=True)
class Scenario:
    """``file``: where it was read; ``start``: where the robot begins, of the world; ``boxes``: how many that
    its map does not show stand about, ``boxes_at``: or where; ``doors``: how many are shut meanwhile, or
    which and when; ``people``: who walks about; ``planner``: a
    local one other than the robot's; ``parameters``: of move_base, over those of the robot; ``seconds``:
    simulated ones that a run may take; ``is_over_ros``: whether nodes play it, not one process.
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
    doors: Union[int, Tuple[Door, ...]] = 0
    people: Pedestrians = Pedestrians()
    faults: Tuple[Fault, ...] = ()
    planner: str = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    seconds: float = 600.0
    seeds: Tuple[int, ...] = tuple(range(100))
    is_over_ros: bool = False

    def with_planner(self, planner: str) -> "Scenario":
        """The same with another local planner."""
        return replace(self, planner=planner)

    def with_parameters(self, parameters: Mapping[str, Any]) -> "Scenario":
        """The same with other parameters of move_base."""
        return replace(self, parameters=parameters)

    @property
    def label(self) -> str:
        """Its name, who plans if that is not the robot's usual planner, and what plays it."""
        name = f"{self.name} [{self.planner}]" if self.planner else self.name
        return f"{name} over ROS" if self.is_over_ros else name

    def digest(self) -> str:
        """Digest of all that changes a run: see ``scenario_digest``."""
        return scenario_digest(self)

    def arena(self, seed: int) -> Arena:
        """The world of a seed, with what stands about in it. Raises PlanarError."""
        from laboratory.worlds.boxes import with_boxes, with_boxes_at
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
        if self.people.count:
            arena = with_people(arena, self.people, seed, self.start, self.task.required_poses(arena))
        return arena
