"""Settings of following."""

from dataclasses import dataclass

from planar.config.settings import check_parameters, parameter


@dataclass(frozen=True)
class FollowSettings:
    """Metres, radians and seconds."""

    gap: float = parameter("gap", 0.7, "how far behind the leader to stay, along its way, m", 0.1)
    slack: float = parameter(
        "slack", 0.2, "how much farther a leader may go before one sets off after it, m", 0.0
    )
    goal_shift: float = parameter("goal_shift", 0.1, "a goal that has moved by this is sent anew, m", 0.01)
    goal_turn: float = parameter("goal_turn", 0.5, "a goal that has turned by this is sent anew, rad", 0.05)
    goal_period: float = parameter("goal_period", 0.2, "how often to look where the leader is, s", 0.05)

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class NodeSettings(FollowSettings):
    """What the node needs besides."""

    map_frame: str = parameter("map_frame", "map", "frame of the goals")
    base_frame: str = parameter("base_frame", "base_footprint", "frame of the robot that follows")
    leader_frame: str = parameter("leader_frame", "leader/base_footprint", "frame of the robot it follows")
