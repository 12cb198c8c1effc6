"""Conversion of 3D poses and kinematic states to messages and back."""

import math
from typing import List, Sequence, Tuple

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3

from planar.geometry.limits import MAX_COORDINATE, is_within
from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import from_quaternion, position, quaternion
from sim_bridge.physics.kinematics import KinematicState

# A quaternion shorter than this counts as zero, as in messages with default values.
SHORTEST_QUATERNION = 1e-6


def pose3_to_msg(pose: np.ndarray) -> Pose:
    return Pose(Point(*position(pose)), Quaternion(*quaternion(pose)))


def pose3_from_msg(message: Pose) -> np.ndarray:
    """Convert a pose; a zero quaternion is the identity.

    Returns:
        The pose (4, 4).

    Raises:
        WorldError: A number is not finite, or too large for a coordinate.
    """
    q, at = message.orientation, message.position
    values = (q.x, q.y, q.z, q.w, at.x, at.y, at.z)
    if not all(math.isfinite(value) for value in values):
        raise WorldError("the pose is not finite")
    if not is_within(MAX_COORDINATE, *values):
        raise WorldError("nothing can be at the pose")
    is_turned = float(np.linalg.norm(values[:4])) > SHORTEST_QUATERNION
    pose = from_quaternion(values[:4] if is_turned else (0.0, 0.0, 0.0, 1.0))
    pose[:3, 3] = values[4:]
    return pose


def state_to_msgs(motion: KinematicState) -> Tuple[Pose, Twist]:
    return pose3_to_msg(motion.pose), Twist(Vector3(*motion.linear), Vector3(*motion.angular))


def state_from_msgs(pose: Pose, twist: Twist) -> KinematicState:
    """Convert a pose and a twist to a kinematic state.

    Raises:
        WorldError: A number is not finite, or too large.
    """
    linear, angular = vector_from_msg(twist.linear), vector_from_msg(twist.angular)
    if not (np.isfinite(linear).all() and np.isfinite(angular).all()):
        raise WorldError("the twist is not finite")
    if not is_within(MAX_COORDINATE, *linear, *angular):
        raise WorldError("nothing is as fast as the twist")
    return KinematicState(pose3_from_msg(pose), linear, angular)


def vector_from_msg(message) -> np.ndarray:
    """Convert a Vector3 or Point to an array (3,)."""
    return np.array([message.x, message.y, message.z])


def covariance_of(variances: Sequence[float]) -> List[float]:
    """Return the covariance matrix of independent values.

    Args:
        variances: Variance of each of N values.

    Returns:
        The matrix (N * N,), row by row.
    """
    return np.diag(variances).ravel().tolist()
