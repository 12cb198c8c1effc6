"""Precision of values that pass from one component to another: exact, or that of ROS messages."""

from dataclasses import replace
from typing import Protocol

import numpy as np

from planar import OccupancyGrid, Pose2, Scan
from planar.geometry.pose import quaternion_zw, yaw_of_quaternion


class Encoding(Protocol):
    """Changes values as their transport does."""

    def pose(self, pose: Pose2) -> Pose2:
        """Return a pose as it is received."""

    def scan(self, scan: Scan) -> Scan:
        """Return a scan as it is received."""

    def grid(self, grid: OccupancyGrid) -> OccupancyGrid:
        """Return a map as it is received."""


class ExactValues:
    """Values pass unchanged, as arguments of calls."""

    def pose(self, pose: Pose2) -> Pose2:
        return pose

    def scan(self, scan: Scan) -> Scan:
        return scan

    def grid(self, grid: OccupancyGrid) -> OccupancyGrid:
        return grid


class MessageValues:
    """Values have the precision of ROS messages.

    Headings are quaternions; the angles and limits of sensor_msgs/LaserScan and the resolution of
    nav_msgs/OccupancyGrid are float32.
    """

    def pose(self, pose: Pose2) -> Pose2:
        return Pose2(pose.x, pose.y, yaw_of_quaternion(0.0, 0.0, *quaternion_zw(pose.yaw)))

    def scan(self, scan: Scan) -> Scan:
        return replace(
            scan,
            angle_min=_float32(scan.angle_min),
            angle_increment=_float32(scan.angle_increment),
            range_min=_float32(scan.range_min),
            range_max=_float32(scan.range_max),
            laser_in_base=self.pose(scan.laser_in_base),
        )

    def grid(self, grid: OccupancyGrid) -> OccupancyGrid:
        return replace(grid, resolution=_float32(grid.resolution), origin=self.pose(grid.origin))


def _float32(value: float) -> float:
    return float(np.float32(value))
