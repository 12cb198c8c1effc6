"""Whether two closures tell the same story."""

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
    slide: np.ndarray,
    other_slide: np.ndarray,
) -> Tuple[float, float]:
    """Metres and radians by which place - recent - other recent - other place - place does not close.

    ``recent_step``, ``place_step``: from the ends of one closure to those of the other. ``slide``: unit
    vector (2,), along its first node's axes, in which a closure knows nothing, or zeros; errors along it are
    none.
    """
    told, retold = one.second_in_first @ recent_step, place_step @ other.second_in_first
    error = np.array([retold.x - told.x, retold.y - told.y])
    for each in (slide, turned(other_slide, place_step.yaw)):
        error -= (error @ each) * each
    return math.hypot(*error), abs(wrap(retold.yaw - told.yaw))


def turned(vector: np.ndarray, yaw: float) -> np.ndarray:
    """A vector (2,) turned by ``yaw``."""
    return Pose2(0.0, 0.0, yaw).transform_points(vector[None])[0]
