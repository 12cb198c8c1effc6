"""One robot follows another at a distance, without ROS; the node is in ``follow_me.ros.node``."""

from follow_me.config import FollowSettings
from follow_me.follower import Follower

__all__ = ["FollowSettings", "Follower"]
