"""Conversion of plans to nav_msgs/Path."""

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from std_msgs.msg import Header

from move_base_lite.planning import headings_along
from planar import Pose2
from planar_ros.messages.conversion import pose2_to_msg


def plan_msg(
    path_xy: np.ndarray,
    stamp: rospy.Time,
    frame: str,
    orientation_mode: int,
    start_yaw: float,
    goal_yaw: float,
) -> Path:
    """Convert a global plan to a message.

    Args:
        path_xy: (N, 2) [m].
        stamp: Stamp of the message.
        frame: Frame of the path.
        orientation_mode: Mode of the headings (see headings_along).
        start_yaw: Heading at the start [rad].
        goal_yaw: Heading at the goal [rad].
    """
    return path_msg(path_xy, stamp, frame, headings_along(path_xy, orientation_mode, start_yaw, goal_yaw))


def path_msg(path_xy: np.ndarray, stamp: rospy.Time, frame: str, yaws: np.ndarray) -> Path:
    """Convert a path with headings to a message.

    Args:
        path_xy: (N, 2) [m].
        stamp: Stamp of the message.
        frame: Frame of the path.
        yaws: (N,) headings [rad].
    """
    return trajectory_msg(np.column_stack((path_xy, yaws)), stamp, frame)


def trajectory_msg(poses: np.ndarray, stamp: rospy.Time, frame: str) -> Path:
    """Convert poses to a message.

    Args:
        poses: (N, 3) of x, y, yaw [m, rad].
        stamp: Stamp of the message.
        frame: Frame of the poses.
    """
    header = Header(stamp=stamp, frame_id=frame)
    return Path(header, [PoseStamped(header, pose2_to_msg(Pose2(*pose))) for pose in poses.tolist()])


def pose_msg(pose: Pose2, stamp: rospy.Time, frame: str) -> PoseStamped:
    """Convert a pose to a message."""
    return PoseStamped(Header(stamp=stamp, frame_id=frame), pose2_to_msg(pose))
