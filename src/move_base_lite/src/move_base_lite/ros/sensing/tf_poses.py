"""Poses of the robot from tf."""

import math
from typing import Callable, Optional, Sequence, TypeVar

import numpy as np
import rospy

from planar import Pose2
from planar_ros.messages.conversion import time_of
from planar_ros.messages.transforms import Transforms

# A stamp in seconds since 1970 is exact to so many nanoseconds only.
STAMP_ERROR = rospy.Duration(0, 1000)
T = TypeVar("T")


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
        return self._at(stamp, self._transforms.lookup, self._odom, self._base)

    def base_in_space(self, stamp: float) -> Optional[np.ndarray]:
        return self._at(stamp, self._transforms.matrix, self._odom, self._base)

    def frame_in_base(self, frame: str, stamp: float) -> Optional[np.ndarray]:
        return self._at(stamp, self._transforms.matrix, self._base, frame)

    def missing_transform(self, frames: Sequence[str], stamp: float) -> str:
        for parent, child in [(self._odom, self._base), *((self._base, frame) for frame in frames)]:
            reason = self._transforms.why_unknown(parent, child, time_of(stamp))
            if reason:
                return f"no transform {parent} -> {child} at their stamps; is it published? ({reason})"
        return "their transforms came too late"

    def odom_in_map(self) -> Optional[Pose2]:
        return self._transforms.lookup(self._map, self._odom)

    def odometry_stamp(self) -> Optional[float]:
        return self._latest(self._odom, self._base)

    def localization_stamp(self) -> Optional[float]:
        return self._latest(self._map, self._odom)

    def reset(self) -> None:
        self._transforms.clear()

    def _at(self, stamp: float, lookup: Callable[..., Optional[T]], parent: str, child: str) -> Optional[T]:
        """Look up a pose at a stamp that seconds may not represent exactly."""
        time = time_of(stamp)
        pose = lookup(parent, child, time)
        if pose is None:
            latest = self._transforms.latest_stamp(parent, child)
            if latest is not None and rospy.Duration(0) < time - latest < STAMP_ERROR:
                pose = lookup(parent, child, latest)
        return pose

    def _latest(self, parent: str, child: str) -> Optional[float]:
        """Return the newest stamp of a transform; infinity if it is static."""
        latest = self._transforms.latest_stamp(parent, child)
        if latest is None:
            return None
        return latest.to_sec() if latest != rospy.Time(0) else math.inf
