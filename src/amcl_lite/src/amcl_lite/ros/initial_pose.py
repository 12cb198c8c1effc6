"""Poses that people and programs tell: topic ``initialpose``."""

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

# How long a pose may wait for the odometry of its stamp, which moves it to the present.
PATIENCE = rospy.Duration(0.5)
RETRY_SECONDS = 0.1


class _PendingPose(NamedTuple):
    """A pose in the map, of ``stamp``; ``covariance`` (3, 3), m^2 and rad^2."""

    pose: Pose2
    covariance: np.ndarray
    stamp: rospy.Time
    received_at: rospy.Time
    force_update: bool

    def has_waited(self, now: rospy.Time) -> bool:
        """Whether it is time to do without odometry; after a jump back of time it is."""
        return not self.received_at <= now < self.received_at + PATIENCE


class InitialPoseSubscriber:
    """Starts the localizer anew around each pose told, moved on by what the robot has driven since.

    A pose whose odometry has not come yet waits for it, but no callback does: in step no time passes then.
    """

    def __init__(self, shared: LockedLocalizer, tf_bridge: TfBridge, step: LockstepClient):
        self._shared, self._tf_bridge = shared, tf_bridge
        self._waiting: Optional[_PendingPose] = None
        self._lock = threading.Lock()
        subscribe("initialpose", PoseWithCovarianceStamped, self._on_initial_pose, queue_size=2)
        step.every(lambda: RETRY_SECONDS, self._retry, lambda: None)

    def handle(self, message: PoseWithCovarianceStamped, force_update: bool) -> None:
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
    """The (3, 3) of x, y and yaw out of the 36 numbers of a message."""
    whole: np.ndarray = np.reshape(covariance, (6, 6))
    planar = np.zeros((3, 3))
    planar[:2, :2] = whole[:2, :2]
    planar[2, 2] = whole[5, 5]
    return planar
