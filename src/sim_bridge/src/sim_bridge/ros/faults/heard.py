"""Scans, odometry and commands that know by which message they came.

Faults change what is planar of them; whatever else the message holds is told as it was heard.
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
from planar_ros.messages.border import LATEST_STAMP, MessageError
from planar_ros.messages.conversion import (
    LaserScanArrays,
    pose2_from_msg,
    scan_from_msg,
    time_of,
    twist2_from_msg,
)
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.ros.messages import pose3_from_msg, pose3_to_msg
from sim_bridge.sensors.odometry import Odometry


@dataclass(frozen=True, eq=False)
class HeardScan(Scan):
    """``message`` goes along where a fault replaces values, or keeps the scan for later."""

    kind: ClassVar[Any] = LaserScanArrays
    message: Any = None

    @classmethod
    def of(cls, message) -> "HeardScan":
        """Directions are the laser's own. Raises PlanarError for a message that holds no scan."""
        values = vars(scan_from_msg(message, Pose2()))
        return cls(**{**values, "intensities": message.intensities, "message": message})

    def tell(self, told: Scan) -> Any:
        """The message that tells ``told`` when this one was heard."""
        source = _source(told, self)
        message = copy.copy(source)
        message.header = _header(told.stamp, source.header, self.message.header)
        message.angle_min, message.angle_increment = told.angle_min, told.angle_increment
        message.ranges, message.intensities = _floats(told.ranges), _floats(told.intensities)
        message.range_min = told.range_min
        if told.range_max != min(source.range_max, MAX_COORDINATE):
            message.range_max = told.range_max
        if _fan(message) != _fan(source):
            message.angle_max = told.angle_min + told.angle_increment * (len(told.ranges) - 1)
        return message


@dataclass(frozen=True)
class HeardOdometry(Odometry):
    """``message`` goes along if a fault keeps it for later; the header is that of the moment."""

    kind: ClassVar[Any] = OdometryMessage
    message: Any = field(default=None, compare=False)

    @classmethod
    def of(cls, message) -> "HeardOdometry":
        """Raises PlanarError for a message of no place or velocity of a robot."""
        return cls(pose2_from_msg(message.pose.pose), twist2_from_msg(message.twist.twist), message)

    def tell(self, told: Odometry) -> Any:
        """The message that tells ``told`` when this one was heard."""
        message = copy.deepcopy(_source(told, self))
        message.header = self.message.header
        _move(message.pose.pose, told.base_in_odom)
        _drive(message.twist.twist, told.twist)
        return message


@dataclass(frozen=True)
class HeardCommand(Twist2):
    """``message`` goes along if a fault keeps it for later."""

    kind: ClassVar[Any] = Twist
    message: Any = field(default=None, compare=False)

    @classmethod
    def of(cls, message) -> "HeardCommand":
        """Raises PlanarError for a velocity of no robot."""
        twist = twist2_from_msg(message)
        return cls(twist.v, twist.omega, message)

    def tell(self, told: Twist2) -> Any:
        """The message that tells ``told`` when this one was heard."""
        message = copy.deepcopy(_source(told, self))
        _drive(message, told)
        return message


def _source(told: Any, heard: Any) -> Any:
    """The message that ``told`` was heard in, if it is an earlier one, else that of ``heard``."""
    return getattr(told, "message", heard.message)


def _header(stamp: float, *headers: Header) -> Header:
    """That of the headers that has the stamp; else the first, dated anew."""
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


def _move(pose, base: Pose2) -> None:
    """Puts it there; height and tilt stay as they are."""
    turn = base.yaw - pose2_from_msg(pose).yaw
    pose.position.x, pose.position.y = base.x, base.y
    if turn:
        pose.orientation = pose3_to_msg(from_pose2(Pose2(yaw=turn)) @ pose3_from_msg(pose)).orientation


def _drive(twist, told: Twist2) -> None:
    twist.linear.x, twist.angular.z = told.v, told.omega
