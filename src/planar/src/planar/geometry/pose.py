"""Poses and velocities in the plane, SE(2)."""

import math
from dataclasses import dataclass
from typing import Any, Mapping, Tuple

import numpy as np

from planar.errors import OutOfRangeError, SettingsError
from planar.geometry.limits import MAX_ANGLE, MAX_COORDINATE


def wrap(angle):
    """Normalize angles to [-pi, pi); a scalar gives a float, an array an array."""
    if isinstance(angle, np.ndarray):
        return (angle + math.pi) % (2.0 * math.pi) - math.pi
    return float((angle + math.pi) % (2.0 * math.pi) - math.pi)


def cos_sin(angles: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Return the cosines and sines of angles, with the same bits wherever the array is in memory.

    numpy before 2.1 takes a view, such as a column of poses, to overlap with a result that happens to be
    allocated just behind it, and then uses another implementation, which rounds differently.

    Args:
        angles: Angles of any shape [rad].
    """
    contiguous = np.ascontiguousarray(angles)
    return np.cos(contiguous), np.sin(contiguous)


@dataclass(frozen=True)
class Pose2:
    """Pose of one frame in another.

    Products read from the outside in: ``base_in_map = odom_in_map @ base_in_odom``.

    Attributes:
        x: Position [m].
        y: Position [m].
        yaw: Heading, counter-clockwise [rad].
    """

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def __matmul__(self, other: "Pose2") -> "Pose2":
        """Transform ``other``, given in the frame of this pose, to the parent frame of this pose."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2(
            self.x + c * other.x - s * other.y,
            self.y + s * other.x + c * other.y,
            wrap(self.yaw + other.yaw),
        )

    def inverse(self) -> "Pose2":
        """Return the pose of the parent frame in this one: ``b_in_a = a_in_b.inverse()``."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return Pose2(-c * self.x - s * self.y, s * self.x - c * self.y, wrap(-self.yaw))

    def transform_points(self, points_xy: np.ndarray) -> np.ndarray:
        """Transform points (N, 2) from the frame of this pose to its parent frame."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return points_xy @ np.array([[c, s], [-s, c]]) + np.array([self.x, self.y])

    def distance_to(self, other: "Pose2") -> float:
        """Return the Euclidean distance between the two positions [m]."""
        return math.hypot(other.x - self.x, other.y - self.y)

    def as_array(self) -> np.ndarray:
        """Return ``[x, y, yaw]`` as float64 (3,)."""
        return np.array([self.x, self.y, self.yaw])

    def as_matrix(self) -> np.ndarray:
        """Return the pose in space, a homogeneous matrix (4, 4) with z 0."""
        matrix = np.eye(4)
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        matrix[:2, :2], matrix[:2, 3] = [[c, -s], [s, c]], (self.x, self.y)
        return matrix

    @classmethod
    def from_array(cls, xyt) -> "Pose2":
        """Make a pose of an ``[x, y, yaw]`` triple."""
        return cls(float(xyt[0]), float(xyt[1]), float(xyt[2]))

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> "Pose2":
        """Return the pose of a mapping with the numbers ``x``, ``y`` and ``yaw``, as ``asdict`` makes it.

        Raises:
            OutOfRangeError: If one is missing, is no number or is out of range.
        """
        try:
            pose = cls(*(float(values[name]) for name in ("x", "y", "yaw")))
        except (LookupError, TypeError, ValueError, OverflowError) as error:
            raise OutOfRangeError(f"no pose of x, y and yaw: {values!r:.100}") from error
        check_pose(pose, "a robot")
        return pose

    def is_finite(self) -> bool:
        """Return whether no coordinate is NaN or infinite."""
        return math.isfinite(self.x) and math.isfinite(self.y) and math.isfinite(self.yaw)

    def is_in_range(self) -> bool:
        """Return whether the pose is finite and its position at most MAX_COORDINATE from the origin."""
        is_near = -MAX_COORDINATE <= self.x <= MAX_COORDINATE and -MAX_COORDINATE <= self.y <= MAX_COORDINATE
        return is_near and -MAX_ANGLE <= self.yaw <= MAX_ANGLE


def check_pose(pose: Pose2, what: str) -> None:
    """Raise OutOfRangeError if a pose, called ``what`` in the message, is out of range."""
    if not pose.is_in_range():
        raise OutOfRangeError(f"{what} at {pose.x:g}, {pose.y:g}, {pose.yaw:g} is out of range")


def pose_of_text(text: str, name: str) -> Pose2:
    """Return the pose of a parameter.

    Args:
        text: ``x y yaw`` [m, m, rad].
        name: Name of the parameter, for messages.

    Raises:
        SettingsError: The text is not a pose.
    """
    try:
        x, y, yaw = map(float, text.split())
    except ValueError:
        x = y = yaw = math.nan
    pose = Pose2(x, y, yaw)
    if not pose.is_in_range():
        raise SettingsError(f"{name} must be a pose, x y yaw [m, m, rad], got {text!r}")
    return pose


@dataclass(frozen=True)
class Twist2:
    """Velocity of a base in the plane.

    Attributes:
        v: Forward speed [m/s].
        omega: Turning rate, positive to the left [rad/s].
        lateral: Speed to the left of an omnidirectional base [m/s].
    """

    v: float = 0.0
    omega: float = 0.0
    lateral: float = 0.0

    def is_finite(self) -> bool:
        """Return whether no speed is NaN or infinite."""
        return math.isfinite(self.v) and math.isfinite(self.omega) and math.isfinite(self.lateral)


def quaternion_zw(yaw: float) -> Tuple[float, float]:
    """Return z and w of the quaternion of a yaw angle [rad]; its x and y are 0."""
    return math.sin(yaw / 2.0), math.cos(yaw / 2.0)


def yaw_of_quaternion(x: float, y: float, z: float, w: float) -> float:
    """Return the yaw of a quaternion, which need not be normalized [rad]."""
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)
