"""Settings of following."""

from dataclasses import dataclass

from planar.config.listing import Section
from planar.config.parameters import Interval, check_parameters, parameter


@dataclass(frozen=True)
class FollowSettings:
    """Metres, radians and seconds."""

    gap: float = parameter(0.6, "how far behind the leader to stay, along its way", "m", Interval(0.1))
    slack: float = parameter(
        0.1, "how much farther a leader may go before one sets off after it", "m", Interval(0.0)
    )
    goal_shift: float = parameter(0.1, "a goal that has moved by this is sent anew", "m", Interval(0.01))
    goal_turn: float = parameter(0.5, "a goal that has turned by this is sent anew", "rad", Interval(0.05))
    goal_period: float = parameter(0.2, "how often to look where the leader is", "s", Interval(0.05))

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class NodeSettings(FollowSettings):
    """What the node needs besides."""

    map_frame: str = parameter("map", "frame of the goals")
    base_frame: str = parameter("base_footprint", "frame of the robot that follows")
    leader_frame: str = parameter("leader/base_footprint", "frame of the robot it follows")


CONFIG_FILES = {
    "follow_me.yaml": Section("", NodeSettings, about="Every parameter of follow_me with its default."),
}
