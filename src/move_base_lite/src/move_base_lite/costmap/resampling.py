"""Resampling of a cost grid into the cells of a window in another frame."""

import math

import numba
import numpy as np

from move_base_lite.costmap.costs import UNKNOWN
from move_base_lite.costmap.window import CostmapWindow
from planar import Pose2


def resample_costs(
    window: CostmapWindow, frame_in_other: Pose2, costs: np.ndarray, origin: Pose2, resolution: float
) -> np.ndarray:
    """Sample costs of another frame at the centres of a window's cells.

    Args:
        window: Cells to fill.
        frame_in_other: The window's frame in the frame of the costs.
        costs: uint8 (rows, cols).
        origin: Lower left corner of the costs in their frame.
        resolution: Cell size of the costs [m].

    Returns:
        Costs of the window's cells, uint8 (rows, cols); UNKNOWN outside the given costs.
    """
    corner_in_other = frame_in_other @ Pose2(window.origin_x, window.origin_y)
    corner_in_costs = origin.inverse() @ corner_in_other
    return _sampled(
        costs,
        corner_in_costs.x / resolution,
        corner_in_costs.y / resolution,
        corner_in_costs.yaw,
        window.resolution / resolution,
        window.rows,
        window.cols,
    )


@numba.njit(cache=True)
def _sampled(costs, x, y, yaw, scale, rows, cols):
    sampled = np.full((rows, cols), UNKNOWN, dtype=np.uint8)
    c, s = math.cos(yaw) * scale, math.sin(yaw) * scale
    for row in range(rows):
        for col in range(cols):
            other_row = math.floor(y + s * (col + 0.5) + c * (row + 0.5))
            other_col = math.floor(x + c * (col + 0.5) - s * (row + 0.5))
            if 0 <= other_row < costs.shape[0] and 0 <= other_col < costs.shape[1]:
                sampled[row, col] = costs[other_row, other_col]
    return sampled
