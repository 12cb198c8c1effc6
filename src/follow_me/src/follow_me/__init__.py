"""One robot follows another at a distance, without ROS; the node is in ``follow_me.ros.node``."""

from follow_me.config import FollowSettings
from follow_me.follower import LeaderFollower
from planar.deprecation import deprecated_names

__all__ = ["FollowSettings", "LeaderFollower"]

__getattr__ = deprecated_names(__name__, {"Follower": "LeaderFollower"})
