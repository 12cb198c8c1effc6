"""Settings of the explorer."""

from dataclasses import dataclass

from planar.config.listing import Section
from planar.config.parameters import POSITIVE, ZERO_OR_MORE, at_least, check_parameters, parameter
from planar.config.settings import check


@dataclass(frozen=True)
class ExplorerSettings:
    """What is worth going to, and how patient the explorer is. Seconds are simulated seconds.

    The cost of a frontier is ``potential_scale`` times the way there, plus ``orientation_scale`` times the
    turn towards it, less ``gain_scale`` times its length; the cheapest is next.
    """

    planner_frequency: float = parameter(1.0, "how often the frontiers are looked over", "Hz", POSITIVE)
    min_frontier_size: float = parameter(0.5, "shorter frontiers are not worth going to", "m", POSITIVE)
    max_frontier_size: float = parameter(2.0, "longer frontiers are taken in parts", "m")
    clearance: float = parameter(
        0.25,
        "between the robot's centre and the next obstacle on the way; more than its radius",
        "m",
        ZERO_OR_MORE,
    )
    goal_clearance: float = parameter(
        0.35, "the same where the robot is sent; also to the unknown, if possible", "m", ZERO_OR_MORE
    )
    reach: float = parameter(1.5, "a frontier is looked at from no further than this", "m", POSITIVE)
    field_of_view: float = parameter(
        0.0,
        "what the laser sees at once; 0: as the first scan on scan says. One that does not see all around is "
        "turned to the frontiers within reach before the robot drives on",
        "rad",
        ZERO_OR_MORE,
    )
    potential_scale: float = parameter(
        1.0,
        "cost of a metre of the way there",
        bounds=ZERO_OR_MORE,
        heading="The frontier with the lowest cost is next.",
    )
    orientation_scale: float = parameter(
        0.5, "cost of a radian that the robot has to turn", bounds=ZERO_OR_MORE
    )
    gain_scale: float = parameter(0.5, "what a metre of the frontier's length is worth", bounds=ZERO_OR_MORE)
    switch_gain: float = parameter(
        1.0, "by how much another frontier must be cheaper than the one under way", bounds=ZERO_OR_MORE
    )
    progress_timeout: float = parameter(
        10.0,
        "a goal that has come no nearer for so long is given up",
        "s",
        POSITIVE,
        heading="How patient it is.",
    )
    map_patience: float = parameter(
        6.0, "how long to wait at a goal for a map that shows what is seen there", "s", ZERO_OR_MORE
    )
    attempts: int = parameter(
        2, "viewpoints from which a frontier is tried before it is given up", bounds=at_least(1)
    )
    blacklist_radius: float = parameter(0.4, "places nearer than this count as the same", "m", POSITIVE)

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
    """Frames, and how long the node waits for others."""

    global_frame: str = parameter("map", "frame of the map and of the goals")
    robot_base_frame: str = parameter("base_footprint", "frame of the robot")
    server_timeout: float = parameter(
        60.0, "how long map, transform or move_base may be missing, by the wall clock", "s", POSITIVE
    )
    autostart: bool = parameter(
        False, "explore, once, as soon as there is all that it takes, without being asked by the action"
    )
    return_to_start: bool = parameter(True, "whether to return then to where that began")

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
