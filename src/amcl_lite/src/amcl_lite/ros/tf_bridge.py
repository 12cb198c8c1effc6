"""The transform map -> odom, and odometry from tf."""

from typing import Optional

import rospy

from amcl_lite.ros.locked_localizer import LockedLocalizer
from planar import Pose2
from planar_ros.messages.conversion import frame_name
from planar_ros.messages.transforms import Transforms


class TfBridge:
    """Broadcasts map -> odom and looks up the motion of the odometry."""

    def __init__(self, transforms: Transforms, shared: LockedLocalizer):
        self._transforms, self._shared = transforms, shared
        self.has_sent = False

    def send(self, odom_in_map: Pose2, stamp: rospy.Time) -> None:
        """Broadcast map -> odom, dated ``transform_tolerance`` ahead, unless ``tf_broadcast`` is off."""
        settings = self._shared.settings
        if settings.tf_broadcast:
            expiry = stamp + rospy.Duration(settings.transform_tolerance)
            frames = frame_name(settings.map_frame), frame_name(settings.odom_frame)
            self._transforms.send(odom_in_map, *frames, expiry)
            self.has_sent = True

    def motion_since(self, stamp: rospy.Time) -> Optional[Pose2]:
        """Return the motion of the odometry since ``stamp``, identity for stamp 0, None if unknown."""
        frames = self._shared.settings.odom_frame, self._shared.settings.base_frame
        if stamp == rospy.Time(0):
            return Pose2()
        base_then, base_now = self._transforms.lookup(*frames, stamp), self._transforms.lookup(*frames)
        if base_now is None or base_then is None:
            return None
        return base_then.inverse() @ base_now
