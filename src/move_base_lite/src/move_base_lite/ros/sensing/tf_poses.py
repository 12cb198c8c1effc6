"""Poses of the robot from tf."""

import math
from typing import Optional

import rospy

from planar import Pose2
from planar_ros.messages.conversion import time_of
from planar_ros.messages.transforms import Transforms

# A stamp in seconds since 1970 is exact to so many nanoseconds only.
STAMP_ERROR = rospy.Duration(0, 1000)


class TfPoses:
    """RobotPoses from tf.

    Args:
        transforms: Transforms from tf.
        map_frame: Frame of the map.
        odom_frame: Frame of the odometry.
        base_frame: Frame of the robot.
    """

    def __init__(self, transforms: Transforms, map_frame: str, odom_frame: str, base_frame: str):
        self._transforms = transforms
        self._map, self._odom, self._base = map_frame, odom_frame, base_frame

    def base_in_odom(self, stamp: Optional[float] = None) -> Optional[Pose2]:
        if stamp is None:
            return self._transforms.lookup(self._odom, self._base)
        time = time_of(stamp)
        pose = self._transforms.lookup(self._odom, self._base, time)
        if pose is None:
            latest = self._transforms.latest_stamp(self._odom, self._base)
            if latest is not None and rospy.Duration(0) < time - latest < STAMP_ERROR:
                pose = self._transforms.lookup(self._odom, self._base, latest)
        return pose

    def odom_in_map(self) -> Optional[Pose2]:
        return self._transforms.lookup(self._map, self._odom)

    def odometry_stamp(self) -> Optional[float]:
        return self._latest(self._odom, self._base)

    def localization_stamp(self) -> Optional[float]:
        return self._latest(self._map, self._odom)

    def reset(self) -> None:
        self._transforms.clear()

    def _latest(self, parent: str, child: str) -> Optional[float]:
        """Return the newest stamp of a transform; infinity if it is static."""
        latest = self._transforms.latest_stamp(parent, child)
        if latest is None:
            return None
        return latest.to_sec() if latest != rospy.Time(0) else math.inf
