"""Scans, odometry and commands that keep the message they were received in.

Faults change their planar values; everything else in the message is passed on as received.
"""

import copy
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry as OdometryMessage
from std_msgs.msg import Header

from planar import Pose2, Scan, Twist2
from planar.geometry.limits import MAX_COORDINATE
from planar_ros.messages.conversion import (
    LaserScanArrays,
    pose2_from_msg,
    scan_from_msg,
    time_of,
    twist2_from_msg,
)
from planar_ros.messages.validation import LATEST_STAMP, MessageError
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.ros.messages import pose3_from_msg, pose3_to_msg
from sim_bridge.sensors.odometry import Odometry


@dataclass(frozen=True, eq=False)
class ReceivedScan(Scan):
    """A scan with its message, also when a fault replaces values or delays the scan."""

    kind: ClassVar[Any] = LaserScanArrays
    message: Any = None

    @classmethod
    def from_msg(cls, message) -> "ReceivedScan":
        """Convert a message; angles are in the laser's frame.

        Raises:
            PlanarError: The message is invalid.
        """
        values = vars(scan_from_msg(message, Pose2()))
        return cls(**{**values, "intensities": message.intensities, "message": message})

    def to_msg(self, changed: Scan) -> Any:
        """Return the message to publish.

        Args:
            changed: The scan that faults have returned for this one.
        """
        source = _source(changed, self)
        message = copy.copy(source)
        message.header = _header(changed.stamp, source.header, self.message.header)
        message.angle_min, message.angle_increment = changed.angle_min, changed.angle_increment
        message.ranges, message.intensities = _floats(changed.ranges), _floats(changed.intensities)
        message.range_min = changed.range_min
        if changed.range_max != min(source.range_max, MAX_COORDINATE):
            message.range_max = changed.range_max
        if _fan(message) != _fan(source):
            message.angle_max = changed.angle_min + changed.angle_increment * (len(changed.ranges) - 1)
        return message


@dataclass(frozen=True)
class ReceivedOdometry(Odometry):
    """Odometry with its message, also when a fault delays it; the header is always the latest."""

    kind: ClassVar[Any] = OdometryMessage
    message: Any = field(default=None, compare=False)

    @classmethod
    def from_msg(cls, message) -> "ReceivedOdometry":
        """Convert a message.

        Raises:
            PlanarError: Its pose or twist is invalid.
        """
        return cls(pose2_from_msg(message.pose.pose), twist2_from_msg(message.twist.twist), message)

    def to_msg(self, changed: Odometry) -> Any:
        """Return the message to publish.

        Args:
            changed: The odometry that faults have returned for this one.
        """
        message = copy.deepcopy(_source(changed, self))
        message.header = self.message.header
        _set_pose(message.pose.pose, changed.base_in_odom)
        _set_twist(message.twist.twist, changed.twist)
        return message


@dataclass(frozen=True)
class ReceivedCommand(Twist2):
    """A velocity command with its message, also when a fault delays it."""

    kind: ClassVar[Any] = Twist
    message: Any = field(default=None, compare=False)

    @classmethod
    def from_msg(cls, message) -> "ReceivedCommand":
        """Convert a message.

        Raises:
            PlanarError: The velocity is invalid.
        """
        twist = twist2_from_msg(message)
        return cls(twist.v, twist.omega, message=message)

    def to_msg(self, changed: Twist2) -> Any:
        """Return the message to publish.

        Args:
            changed: The command that faults have returned for this one.
        """
        message = copy.deepcopy(_source(changed, self))
        _set_twist(message, changed)
        return message


def _source(changed: Any, received: Any) -> Any:
    """Return the message of ``changed`` if it was delayed, else that of ``received``."""
    return getattr(changed, "message", received.message)


def _header(stamp: float, *headers: Header) -> Header:
    """Return the header that has the stamp, else the first with that stamp."""
    for header in headers:
        if header.stamp.to_sec() == stamp:
            return header
    if stamp >= LATEST_STAMP:
        raise MessageError(f"a scan at {stamp:g} s means nothing")
    return Header(headers[0].seq, time_of(max(stamp, 0.0)), headers[0].frame_id)


def _floats(values) -> np.ndarray:
    return np.asarray(values, dtype=np.float32)


def _fan(message) -> tuple:
    return message.angle_min, message.angle_increment, len(message.ranges)


def _set_pose(pose, base: Pose2) -> None:
    """Set x, y and yaw; height and tilt stay."""
    turn = base.yaw - pose2_from_msg(pose).yaw
    pose.position.x, pose.position.y = base.x, base.y
    if turn:
        pose.orientation = pose3_to_msg(from_pose2(Pose2(yaw=turn)) @ pose3_from_msg(pose)).orientation


def _set_twist(twist, planar: Twist2) -> None:
    twist.linear.x, twist.angular.z = planar.v, planar.omega
