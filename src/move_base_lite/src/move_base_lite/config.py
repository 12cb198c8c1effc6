"""Settings of the Navigator, and the configuration files generated from them."""

from dataclasses import dataclass, field
from typing import Any, Mapping, Tuple

from move_base_lite.collision_monitor import MonitorSettings
from move_base_lite.control import LOCAL_PLANNERS, ControllerSettings, DwaSettings
from move_base_lite.control.dwa import DWA, TRAJECTORY
from move_base_lite.control.mppi import MPPI
from move_base_lite.costmap import CostmapSettings
from move_base_lite.costmap.layers.inflation import INFLATION, InflationSettings
from move_base_lite.costmap.layers.obstacles import OBSTACLES, ObstacleSettings, SourceSettings
from move_base_lite.costmap.layers.static import STATIC, StaticSettings
from move_base_lite.planning import GLOBAL_PLANNERS, NavfnSettings, PlannerSettings
from move_base_lite.planning.navfn import GLOBAL_PLANNER, NAVFN
from move_base_lite.recovery import MoveSlowSettings, NamedRecovery, RotateSettings
from move_base_lite.recovery.move_slow import MOVE_SLOW
from planar.config.config_file import ConfigFiles, Section
from planar.config.parameters import POSITIVE, Parameter, at_least, check_parameters, parameter
from planar.extensions import registries_of


@dataclass(frozen=True)
class MoveBaseSettings:
    """move_base's own parameters, and ``sensor_patience``.

    Each field is a parameter; its meaning, unit and bounds are in its ``parameter(...)``.
    """

    controller_frequency: float = parameter(20.0, "rate of velocity commands", "Hz", POSITIVE, dynamic=100.0)
    planner_frequency: float = parameter(
        0.0,
        "rate of planning while driving; 0: only for a new goal or when control fails",
        "Hz",
        at_least(0.0),
        dynamic=100.0,
    )
    planner_patience: float = parameter(
        5.0, "time without a plan until recovery", "s", at_least(0.0), dynamic=100.0
    )
    controller_patience: float = parameter(
        15.0, "time without a safe velocity until recovery", "s", at_least(0.0), dynamic=100.0
    )
    max_planning_retries: int = parameter(
        -1, "failed plans until recovery; -1: only planner_patience counts", dynamic=(-1, 1000)
    )
    oscillation_timeout: float = parameter(
        0.0, "time without progress until recovery; 0: never", "s", at_least(0.0), dynamic=60.0
    )
    oscillation_distance: float = parameter(
        0.5, "displacement that counts as progress", "m", at_least(0.0), dynamic=10.0
    )
    conservative_reset_dist: float = parameter(
        3.0, "side of the square that conservative_reset keeps", "m", dynamic=(0.0, 50.0)
    )
    clearing_rotation_allowed: bool = parameter(
        True, "whether the default recoveries may rotate", dynamic=True
    )
    recovery_behavior_enabled: bool = parameter(
        True, "whether recovery behaviours run before a goal is aborted", dynamic=True
    )
    make_plan_clear_costmap: bool = parameter(
        True, "whether make_plan clears obstacles at the robot's position", dynamic=True
    )
    make_plan_add_unreachable_goal: bool = parameter(
        True, "whether make_plan appends the goal if only its tolerance was reached", dynamic=True
    )
    clearing_radius: float = parameter(
        0.0, "radius around the robot that make_plan clears; 0: that of the footprint", "m", at_least(0.0)
    )
    shutdown_costmaps: bool = parameter(
        False, "whether costmaps are not updated while there is no goal", dynamic=True
    )
    sensor_patience: float = parameter(
        10.0, "time without scans or transforms until the goal is aborted", "s", at_least(0.0)
    )

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class NavigatorSettings:
    """Settings of the Navigator; the types of ``planner`` and ``controller`` select the planners.

    Attributes:
        move_base: move_base's own parameters.
        planner: Settings of the global planner.
        controller: Settings of the local planner.
        global_costmap: Costmap for planning.
        local_costmap: Costmap for control.
        recoveries: Recovery behaviours, in order.
        extensions: Settings of the plugins of other extension points, by the parameter that selects them.
    """

    move_base: MoveBaseSettings = field(default_factory=MoveBaseSettings)
    planner: PlannerSettings = field(default_factory=NavfnSettings)
    controller: ControllerSettings = field(default_factory=DwaSettings)
    global_costmap: CostmapSettings = field(default_factory=CostmapSettings)
    local_costmap: CostmapSettings = field(default_factory=CostmapSettings)
    recoveries: Tuple[NamedRecovery, ...] = ()
    extensions: Mapping[str, Any] = field(default_factory=dict)

    @property
    def scan_topic(self) -> str:
        """Topic of the first laser scan among the observation sources."""
        for costmap in (self.local_costmap, self.global_costmap):
            for source in costmap.sources:
                if source.data_type == "LaserScan":
                    return source.topic
        return "scan"


_COSTMAP = Section(
    "global_costmap",
    CostmapSettings,
    Parameter(
        "plugins",
        [
            {"name": "static_layer", "type": STATIC.name},
            {"name": "obstacle_layer", "type": OBSTACLES.name},
            {"name": "inflation_layer", "type": INFLATION.name},
        ],
        "",
    ),
    Section("static_layer", StaticSettings),
    Section(
        "obstacle_layer",
        ObstacleSettings,
        Parameter("observation_sources", "scan", "names of the sources, separated by spaces"),
        Section("scan", SourceSettings(topic="scan")),
    ),
    Section("inflation_layer", InflationSettings),
)
# The namespace TrajectoryPlannerROS is listed with the defaults of rotate_recovery, which differ.
_PLUGINS = [
    Section(plugin.short_name, plugin.settings)
    for registry in registries_of("move_base_lite").values()
    for plugin in registry.members
    if plugin is not TRAJECTORY
]
_OTHERS = [
    Parameter(key, registry.names[0], registry.point.kind)
    for key, registry in registries_of("move_base_lite").items()
    if registry not in (GLOBAL_PLANNERS, LOCAL_PLANNERS)
]
CONFIG_FILES: ConfigFiles = {
    "move_base_lite.yaml": Section(
        "",
        Parameter(
            "base_global_planner",
            NAVFN.name,
            f"or {GLOBAL_PLANNER.name}, whose use_dijkstra: false means A*",
        ),
        Parameter("base_local_planner", DWA.name, f"or {MPPI.name}, which drives better"),
        *_OTHERS,
        MoveBaseSettings,
        *_PLUGINS,
        Section(TRAJECTORY.short_name, RotateSettings, about="read by rotate_recovery, as in move_base"),
        Section(
            "move_slow", MoveSlowSettings, about=f"read by a recovery of that name, type {MOVE_SLOW.name}"
        ),
        _COSTMAP,
        Section("local_costmap", same_as="global_costmap"),
        about="Every parameter of move_base_lite with its default, that of move_base and its plugins.\n"
        "For a robot, use a preset such as turtlebot.yaml.",
    ),
    "collision_monitor.yaml": Section(
        "", MonitorSettings, about="Parameters of collision_monitor, with their defaults."
    ),
}
