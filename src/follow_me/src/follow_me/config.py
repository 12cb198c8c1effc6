"""Settings of follow_me."""

from dataclasses import dataclass

from planar.config.config_file import Section
from planar.config.parameters import Interval, check_parameters, parameter


@dataclass(frozen=True)
class FollowSettings:
    """Settings of the follower."""

    gap: float = parameter(0.6, "distance to keep behind the leader, along its path", "m", Interval(0.1))
    slack: float = parameter(
        0.1, "additional distance at which a standing follower starts to drive", "m", Interval(0.0)
    )
    goal_shift: float = parameter(
        0.1, "displacement of the goal at which it is sent again", "m", Interval(0.01)
    )
    goal_turn: float = parameter(0.5, "rotation of the goal at which it is sent again", "rad", Interval(0.05))
    goal_period: float = parameter(0.2, "period of goal updates", "s", Interval(0.05))

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class NodeSettings(FollowSettings):
    """Settings of the node: those of the follower, and frames."""

    map_frame: str = parameter("map", "frame of the goals")
    base_frame: str = parameter("base_footprint", "frame of the follower")
    leader_frame: str = parameter("leader/base_footprint", "frame of the leader")


CONFIG_FILES = {
    "follow_me.yaml": Section("", NodeSettings, about="Every parameter of follow_me with its default."),
}
