"""All settings of the Navigator."""

from dataclasses import dataclass, field
from typing import Tuple

from move_base_lite.control import ControllerSettings, DwaSettings
from move_base_lite.costmap import CostmapSettings
from move_base_lite.planning import PlannerSettings
from move_base_lite.recovery import RecoverySettings
from planar.config.settings import check


@dataclass(frozen=True)
class MoveBaseSettings:
    """move_base's own parameters: Hz, seconds, metres.

    ``clearing_radius``: of the square that make_plan clears, 0 for the footprint's. ``sensor_patience``:
    seconds after which a robot whose sensors are silent gives up its goal.
    """

    controller_frequency: float = 20.0
    planner_frequency: float = 0.0
    planner_patience: float = 5.0
    controller_patience: float = 15.0
    max_planning_retries: int = -1
    oscillation_timeout: float = 0.0
    oscillation_distance: float = 0.5
    conservative_reset_dist: float = 3.0
    clearing_rotation_allowed: bool = True
    recovery_behavior_enabled: bool = True
    make_plan_clear_costmap: bool = True
    make_plan_add_unreachable_goal: bool = True
    clearing_radius: float = 0.0
    shutdown_costmaps: bool = False
    sensor_patience: float = 10.0

    def __post_init__(self):
        check(self.controller_frequency > 0.0, "controller_frequency", "positive", self.controller_frequency)
        for name in (
            "planner_frequency",
            "planner_patience",
            "controller_patience",
            "oscillation_timeout",
            "oscillation_distance",
            "clearing_radius",
            "sensor_patience",
        ):
            check(getattr(self, name) >= 0.0, name, "at least 0", getattr(self, name))


@dataclass(frozen=True)
class NavigatorSettings:
    """Everything the Navigator needs to know."""

    move_base: MoveBaseSettings = field(default_factory=MoveBaseSettings)
    planner: PlannerSettings = field(default_factory=PlannerSettings)
    controller: ControllerSettings = field(default_factory=DwaSettings)
    global_costmap: CostmapSettings = field(default_factory=CostmapSettings)
    local_costmap: CostmapSettings = field(default_factory=CostmapSettings)
    recoveries: Tuple[RecoverySettings, ...] = ()

    @property
    def scan_topic(self) -> str:
        """The topic of the first laser that a costmap listens to."""
        for costmap in (self.local_costmap, self.global_costmap):
            for source in costmap.obstacles.sources:
                if source.data_type == "LaserScan":
                    return source.topic
        return "scan"
