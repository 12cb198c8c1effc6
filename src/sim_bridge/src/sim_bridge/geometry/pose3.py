"""3D poses as homogeneous matrices (4, 4): ``a_in_b @ c_in_a == c_in_b``."""

import math
from typing import Iterable, Sequence, Tuple

import numpy as np

from planar import Pose2

IDENTITY = np.eye(4)


def pose3(x=0.0, y=0.0, z=0.0, roll=0.0, pitch=0.0, yaw=0.0) -> np.ndarray:
    """Return the pose of SDF's and URDF's six values; rotations are about fixed axes.

    Args:
        x: Position [m].
        y: Position [m].
        z: Position [m].
        roll: Rotation about x, applied first [rad].
        pitch: Rotation about y [rad].
        yaw: Rotation about z, applied last [rad].

    Returns:
        The homogeneous matrix (4, 4).
    """
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a), math.sin(a)) for a in (roll, pitch, yaw))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, x],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, y],
            [-sp, cp * sr, cp * cr, z],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def from_pose2(pose: Pose2, z: float = 0.0) -> np.ndarray:
    """Return the pose (4, 4) of a planar pose at the height ``z`` [m]."""
    return pose3(pose.x, pose.y, z, yaw=pose.yaw)


def to_pose2(pose: np.ndarray) -> Pose2:
    """Return x, y and yaw of a pose (4, 4)."""
    return Pose2(pose.item(0, 3), pose.item(1, 3), math.atan2(pose.item(1, 0), pose.item(0, 0)))


def quaternion(pose: np.ndarray) -> Tuple[float, float, float, float]:
    """Return the orientation of a pose (4, 4) as a unit quaternion (x, y, z, w) (Shepperd, 1978).

    Plain floats are faster here than numpy.
    """
    (xx, xy, xz, _), (yx, yy, yz, _), (zx, zy, zz, _), _ = pose.tolist()
    most = max(xx + yy + zz, xx, yy, zz)
    if most == xx + yy + zz:
        q = zy - yz, xz - zx, yx - xy, 1.0 + most
    elif most == xx:
        q = 1.0 + xx - yy - zz, yx + xy, xz + zx, zy - yz
    elif most == yy:
        q = yx + xy, 1.0 + yy - zz - xx, zy + yz, xz - zx
    else:
        q = xz + zx, zy + yz, 1.0 + zz - xx - yy, yx - xy
    length = math.hypot(*q)
    return q[0] / length, q[1] / length, q[2] / length, q[3] / length


def from_quaternion(q: Sequence[float]) -> np.ndarray:
    """Return the pose (4, 4), at the origin, of a quaternion (x, y, z, w) of any length but zero."""
    x, y, z, w = np.asarray(q, dtype=float) / np.linalg.norm(q)
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return pose


def inverse(pose: np.ndarray) -> np.ndarray:
    """Return the inverse (4, 4) of a rigid pose; numpy's general inverse would start BLAS threads."""
    inverted = np.eye(4)
    inverted[:3, :3] = pose[:3, :3].T
    inverted[:3, 3] = -(pose[:3, :3].T @ pose[:3, 3])
    return inverted


def transform_points(pose: np.ndarray, points_xyz: np.ndarray) -> np.ndarray:
    """Transform points from a frame into its parent frame.

    Args:
        pose: Pose (4, 4) of the frame in its parent.
        points_xyz: Points (N, 3) in the frame.

    Returns:
        The points (N, 3) in the parent frame.
    """
    return points_xyz @ pose[:3, :3].T + pose[:3, 3]


def cross(a: Iterable[float], b: Iterable[float]) -> np.ndarray:
    """Return the cross product (3,); ten times as fast as numpy's for single vectors."""
    (ax, ay, az), (bx, by, bz) = a, b
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def position(pose: np.ndarray) -> Sequence[float]:
    """Return x, y and z of a pose (4, 4) as a list."""
    return pose[:3, 3].tolist()
