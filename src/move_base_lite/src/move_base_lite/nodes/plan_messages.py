"""Plans as nav_msgs/Path."""

import numpy as np
import rospy
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from nav_msgs.msg import Path
from std_msgs.msg import Header

from planar import Pose2
from planar_ros.messages import pose2_to_msg, quaternion_of


def path_msg(path_xy: np.ndarray, stamp: rospy.Time, frame: str, last_yaw: float = 0.0) -> Path:
    """A path (N, 2) as navfn publishes it: no orientation but at its end."""
    header = Header(stamp=stamp, frame_id=frame)
    level = Quaternion(0.0, 0.0, 0.0, 1.0)
    poses = [PoseStamped(header, Pose(Point(x, y, 0.0), level)) for x, y in path_xy.tolist()]
    if poses:
        poses[-1].pose.orientation = quaternion_of(last_yaw)
    return Path(header, poses)


def trajectory_msg(poses: np.ndarray, stamp: rospy.Time, frame: str) -> Path:
    """Poses (N, 3) as a path."""
    header = Header(stamp=stamp, frame_id=frame)
    return Path(header, [PoseStamped(header, pose2_to_msg(Pose2(*pose))) for pose in poses.tolist()])


def pose_msg(pose: Pose2, stamp: rospy.Time, frame: str) -> PoseStamped:
    return PoseStamped(Header(stamp=stamp, frame_id=frame), pose2_to_msg(pose))
