"""Costs that lie in another frame, turned and at another resolution, in the cells of a window."""

import math

import numba
import numpy as np

from move_base_lite.costmap.costs import UNKNOWN
from move_base_lite.costmap.window import CostmapWindow
from planar import Pose2


def resample_costs(
    window: CostmapWindow, frame_in_other: Pose2, costs: np.ndarray, origin: Pose2, resolution: float
) -> np.ndarray:
    """What a window shows of ``costs``, uint8 (rows, cols), UNKNOWN beyond them.

    ``frame_in_other``: the window's frame in that of the costs; ``origin``, ``resolution``: theirs, metres.
    """
    corner_in_other = frame_in_other @ Pose2(window.origin_x, window.origin_y)
    corner_in_costs = origin.inverse() @ corner_in_other
    return _seen_through(
        costs,
        corner_in_costs.x / resolution,
        corner_in_costs.y / resolution,
        corner_in_costs.yaw,
        window.resolution / resolution,
        window.rows,
        window.cols,
    )


@numba.njit(cache=True)
def _seen_through(costs, x, y, yaw, scale, rows, cols):
    seen = np.full((rows, cols), UNKNOWN, dtype=np.uint8)
    c, s = math.cos(yaw) * scale, math.sin(yaw) * scale
    for row in range(rows):
        for col in range(cols):
            other_row = math.floor(y + s * (col + 0.5) + c * (row + 0.5))
            other_col = math.floor(x + c * (col + 0.5) - s * (row + 0.5))
            if 0 <= other_row < costs.shape[0] and 0 <= other_col < costs.shape[1]:
                seen[row, col] = costs[other_row, other_col]
    return seen
