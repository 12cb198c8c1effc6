"""Initial poses from the topic ``initialpose``."""

import threading
from typing import NamedTuple, Optional

import numpy as np
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped

from amcl_lite.ros.locked_localizer import LockedLocalizer
from amcl_lite.ros.tf_bridge import TfBridge
from planar import Pose2
from planar.geometry.limits import MAX_COORDINATE, check_within
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import frame_name, pose2_from_msg
from planar_ros.messages.validation import subscribe

# Longest wait for the odometry at the stamp of a pose, which is needed to predict it to now.
PATIENCE = rospy.Duration(0.5)
RETRY_SECONDS = 0.1


class _PendingPose(NamedTuple):
    """A pose in the map at ``stamp`` with its covariance (3, 3) [m^2, rad^2]."""

    pose: Pose2
    covariance: np.ndarray
    stamp: rospy.Time
    received_at: rospy.Time
    force_update: bool

    def has_waited(self, now: rospy.Time) -> bool:
        """Whether the wait for odometry is over, also after a jump back of time."""
        return not self.received_at <= now < self.received_at + PATIENCE


class InitialPoseSubscriber:
    """Restarts the filter around each received pose, predicted by the odometry since its stamp.

    A pose whose odometry has not arrived is retried by a timer: in lock-step, no time passes while a callback
    blocks.
    """

    def __init__(self, shared: LockedLocalizer, tf_bridge: TfBridge, lockstep: LockstepClient):
        self._shared, self._tf_bridge = shared, tf_bridge
        self._waiting: Optional[_PendingPose] = None
        self._lock = threading.Lock()
        subscribe("initialpose", PoseWithCovarianceStamped, self._on_initial_pose, queue_size=2)
        lockstep.every(lambda: RETRY_SECONDS, self._retry, lambda: None)

    def handle(self, message: PoseWithCovarianceStamped, force_update: bool) -> None:
        """Handle a pose; with ``force_update`` the next scan is used. An unusable frame is a warning.

        Raises PlanarError for a pose out of range.
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
        pose, covariance = pose2_from_msg(message.pose.pose), _planar(message.pose.covariance)
        check_within(MAX_COORDINATE, "an initial pose", covariance=float(np.abs(covariance).max()))
        now = rospy.Time.now()
        with self._lock:
            self._waiting = None  # the newest counts
            self._use(_PendingPose(pose, covariance, message.header.stamp, now, force_update), now)

    def _on_initial_pose(self, message):
        self.handle(message, self._shared.settings.force_update_after_initialpose)

    def _retry(self, now):
        with self._lock:
            pending, self._waiting = self._waiting, None
            if pending is not None:
                self._use(pending, now)

    def _use(self, pending, now):
        motion = self._tf_bridge.motion_since(pending.stamp)
        if motion is None and not pending.has_waited(now):
            self._waiting = pending
            return
        if motion is None and self._tf_bridge.has_sent:
            rospy.logwarn("Failed to transform initial pose in time (no odometry at its stamp)")
        pose = pending.pose @ (motion or Pose2())
        self._shared.set_pose(pose, pending.covariance, pending.force_update)
        rospy.loginfo("Setting pose (%.6f): %.3f %.3f %.3f", now.to_sec(), pose.x, pose.y, pose.yaw)


def _planar(covariance) -> np.ndarray:
    """Extract the covariance (3, 3) of x, y, yaw from the 36 numbers of a message."""
    whole: np.ndarray = np.reshape(covariance, (6, 6))
    planar = np.zeros((3, 3))
    planar[:2, :2] = whole[:2, :2]
    planar[2, 2] = whole[5, 5]
    return planar
