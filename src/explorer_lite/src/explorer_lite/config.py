"""Settings of the explorer."""

from dataclasses import dataclass

from planar.config.config_file import Section
from planar.config.parameters import POSITIVE, ZERO_OR_MORE, at_least, check_parameters, parameter
from planar.config.settings import check


@dataclass(frozen=True)
class ExplorerSettings:
    """Selection of frontiers, and timeouts in simulated seconds.

    The cost of a frontier is ``potential_scale`` times the distance to it, plus ``orientation_scale`` times
    the turn towards it, minus ``gain_scale`` times its length (explore_lite's cost); the cheapest is next.
    """

    planner_frequency: float = parameter(1.0, "rate at which frontiers are evaluated", "Hz", POSITIVE)
    min_frontier_size: float = parameter(0.5, "minimum length of a frontier", "m", POSITIVE)
    max_frontier_size: float = parameter(2.0, "longer frontiers are split", "m")
    clearance: float = parameter(
        0.25,
        "from the robot's centre to obstacles along a path; more than its radius",
        "m",
        ZERO_OR_MORE,
    )
    goal_clearance: float = parameter(
        0.35, "the same at a goal; also to unknown space, if possible", "m", ZERO_OR_MORE
    )
    reach: float = parameter(1.5, "maximum distance from a goal to its frontier", "m", POSITIVE)
    field_of_view: float = parameter(
        0.0,
        "field of view of the laser; 0: of the first message on scan. With a narrow one, the robot turns to "
        "the frontiers within reach before it drives on",
        "rad",
        ZERO_OR_MORE,
    )
    potential_scale: float = parameter(
        1.0,
        "cost per metre of path",
        bounds=ZERO_OR_MORE,
        heading="The frontier with the lowest cost is next.",
    )
    orientation_scale: float = parameter(0.5, "cost per radian of turning", bounds=ZERO_OR_MORE)
    gain_scale: float = parameter(0.5, "gain per metre of frontier length", bounds=ZERO_OR_MORE)
    switch_gain: float = parameter(
        1.0, "cost difference above which the robot switches to another frontier", bounds=ZERO_OR_MORE
    )
    progress_timeout: float = parameter(
        10.0,
        "time without progress after which a goal is cancelled",
        "s",
        POSITIVE,
        heading="Timeouts and attempts.",
    )
    map_patience: float = parameter(6.0, "time to wait at a goal for a map update", "s", ZERO_OR_MORE)
    attempts: int = parameter(
        2, "viewpoints tried per frontier before it counts as unreachable", bounds=at_least(1)
    )
    blacklist_radius: float = parameter(
        0.4, "distance below which two positions count as the same", "m", POSITIVE
    )

    def __post_init__(self):
        check_parameters(self)
        check(
            self.max_frontier_size > self.min_frontier_size,
            "max_frontier_size",
            f"more than min_frontier_size ({self.min_frontier_size:g})",
            self.max_frontier_size,
        )


@dataclass(frozen=True)
class NodeSettings:
    """Settings of the node: frames and start."""

    global_frame: str = parameter("map", "frame of the map and of the goals")
    robot_base_frame: str = parameter("base_footprint", "frame of the robot")
    server_timeout: float = parameter(
        60.0, "wall time for which map, transform or move_base may be missing", "s", POSITIVE
    )
    autostart: bool = parameter(
        False, "explore once, as soon as map, transform and move_base are available, without an action goal"
    )
    return_to_start: bool = parameter(True, "with autostart: return to the start pose at the end")

    def __post_init__(self):
        check_parameters(self)


CONFIG_FILES = {
    "explorer_lite.yaml": Section(
        "",
        NodeSettings,
        ExplorerSettings,
        about="Every parameter of explorer_lite with its default. Seconds are simulated seconds.",
    )
}
