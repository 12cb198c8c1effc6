"""Poses that people and programs tell: topic ``initialpose``."""

import numpy as np
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped

from amcl_lite.ros.shared_localizer import SharedLocalizer
from amcl_lite.ros.tf_bridge import TfBridge
from planar.geometry.limits import FARTHEST, check_within
from planar_ros.messages.border import listen
from planar_ros.messages.conversion import frame_name, pose2_from_msg


class InitialPoses:
    """Starts the localizer anew around each pose told, moved on by what the robot has driven since."""

    def __init__(self, shared: SharedLocalizer, tf_bridge: TfBridge):
        self._shared, self._tf_bridge = shared, tf_bridge
        listen("initialpose", PoseWithCovarianceStamped, self._on_initial_pose, queue_size=2)

    def take(self, message: PoseWithCovarianceStamped, force_update: bool) -> None:
        """Warns of a pose that cannot be used; with ``force_update`` the next scan counts.

        Raises PlanarError for a pose at which no robot can be.
        """
        frame, map_frame = frame_name(message.header.frame_id), frame_name(self._shared.settings.map_frame)
        if frame == "":
            rospy.logwarn("Received initial pose with empty frame_id.  You should always supply a frame_id.")
        elif frame != map_frame:
            rospy.logwarn(
                'Ignoring initial pose in frame "%s"; initial poses must be in the global frame, "%s"',
                frame,
                map_frame,
            )
            return
        motion = self._tf_bridge.motion_since(message.header.stamp)
        pose, covariance = pose2_from_msg(message.pose.pose) @ motion, _planar(message.pose.covariance)
        check_within(FARTHEST, "an initial pose", covariance=float(np.abs(covariance).max()))
        self._shared.set_pose(pose, covariance, force_update)
        rospy.loginfo("Setting pose (%.6f): %.3f %.3f %.3f", rospy.get_time(), pose.x, pose.y, pose.yaw)

    def _on_initial_pose(self, message):
        self.take(message, self._shared.settings.force_update_after_initialpose)


def _planar(covariance) -> np.ndarray:
    """The (3, 3) of x, y and yaw out of the 36 numbers of a message."""
    whole: np.ndarray = np.reshape(covariance, (6, 6))
    planar = np.zeros((3, 3))
    planar[:2, :2] = whole[:2, :2]
    planar[2, 2] = whole[5, 5]
    return planar
