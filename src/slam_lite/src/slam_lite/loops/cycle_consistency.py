"""Consistency of two loop closures: the error around the cycle that they form."""

import math
from typing import Tuple

import numpy as np

from planar import Pose2, wrap
from slam_lite.graph.pose_graph import Edge


def cycle_error(
    one: Edge,
    other: Edge,
    recent_step: Pose2,
    place_step: Pose2,
    degenerate: np.ndarray,
    other_degenerate: np.ndarray,
) -> Tuple[float, float]:
    """Compute the error around the cycle place - recent - other recent - other place - place.

    Args:
        one: Edge from a place to a recent keyframe.
        other: Edge from another place to another recent keyframe.
        recent_step: Pose of the other recent keyframe in the recent one.
        place_step: Pose of the other place in the place.
        degenerate: Unit vector (2,), along the axes of the place, in which ``one`` has no information, or
            zeros; errors along it do not count.
        other_degenerate: The same for ``other``, along the axes of the other place.

    Returns:
        Error of position [m] and of heading [rad].
    """
    via_recent, via_place = one.second_in_first @ recent_step, place_step @ other.second_in_first
    error = np.array([via_place.x - via_recent.x, via_place.y - via_recent.y])
    for direction in (degenerate, rotated(other_degenerate, place_step.yaw)):
        error -= (error @ direction) * direction
    return math.hypot(*error), abs(wrap(via_place.yaw - via_recent.yaw))


def rotated(vector: np.ndarray, yaw: float) -> np.ndarray:
    """Rotate a vector (2,) by ``yaw`` [rad]."""
    return Pose2(0.0, 0.0, yaw).transform_points(vector[None])[0]
