"""Rigid poses in the plane, SE(2)."""

import math
from dataclasses import dataclass

import numpy as np

from planar.geometry.limits import MAX_ANGLE, MAX_COORDINATE, OutOfRangeError


def wrap(angle):
    """Angle(s) brought into [-pi, pi); scalar in, float out; array in, array out."""
    if isinstance(angle, np.ndarray):
        return (angle + math.pi) % (2.0 * math.pi) - math.pi
    return float((angle + math.pi) % (2.0 * math.pi) - math.pi)


@dataclass(frozen=True)
class Pose2:
    """Where one frame lies in another: ``x``, ``y`` in metres, ``yaw`` in radians, counter-clockwise.

    Products read from the outside in: ``base_in_map = odom_in_map @ base_in_odom``.
    """

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def __matmul__(self, other: "Pose2") -> "Pose2":
        """The pose ``other``, given in this pose's frame, seen from the frame this pose is given in."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2(
            self.x + c * other.x - s * other.y,
            self.y + s * other.x + c * other.y,
            wrap(self.yaw + other.yaw),
        )

    def inverse(self) -> "Pose2":
        """The outer frame seen from this pose: ``b_in_a = a_in_b.inverse()``."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2(-c * self.x - s * self.y, s * self.x - c * self.y, wrap(-self.yaw))

    def transform_points(self, points_xy: np.ndarray) -> np.ndarray:
        """Points (N, 2) in this pose's frame, as (N, 2) in the frame this pose is given in."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return points_xy @ np.array([[c, s], [-s, c]]) + np.array([self.x, self.y])

    def distance_to(self, other: "Pose2") -> float:
        """Straight distance between the two positions, metres."""
        return math.hypot(other.x - self.x, other.y - self.y)

    def as_array(self) -> np.ndarray:
        """``[x, y, yaw]`` as float64 (3,)."""
        return np.array([self.x, self.y, self.yaw])

    @classmethod
    def from_array(cls, xyt) -> "Pose2":
        """The pose of an ``[x, y, yaw]`` triple."""
        return cls(float(xyt[0]), float(xyt[1]), float(xyt[2]))

    def is_finite(self) -> bool:
        """Whether no coordinate is NaN or infinite."""
        return math.isfinite(self.x) and math.isfinite(self.y) and math.isfinite(self.yaw)

    def is_in_range(self) -> bool:
        """Whether a robot can be there: finite, and no farther than ``MAX_COORDINATE`` from the origin."""
        is_near = -MAX_COORDINATE <= self.x <= MAX_COORDINATE and -MAX_COORDINATE <= self.y <= MAX_COORDINATE
        return is_near and -MAX_ANGLE <= self.yaw <= MAX_ANGLE


def check_pose(pose: Pose2, what: str) -> None:
    """Raises OutOfRangeError for a pose, called ``what``, at which no robot can be."""
    if not pose.is_in_range():
        raise OutOfRangeError(f"{what} at {pose.x:g}, {pose.y:g}, {pose.yaw:g} means nothing")


@dataclass(frozen=True)
class Twist2:
    """Velocity of a differential-drive base: ``v`` forward in m/s, ``omega`` to the left in rad/s."""

    v: float = 0.0
    omega: float = 0.0

    def is_finite(self) -> bool:
        """Whether neither speed is NaN or infinite."""
        return math.isfinite(self.v) and math.isfinite(self.omega)
