"""The map as a layer of a costmap (costmap_2d's static layer)."""

import math
from dataclasses import dataclass

import numba
import numpy as np

from move_base_lite.costmap.costs import FREE, LETHAL, UNKNOWN
from move_base_lite.costmap.window import Window
from planar import OccupancyGrid, Pose2
from planar.config.settings import check


@dataclass(frozen=True)
class StaticSettings:
    enabled: bool = True
    map_topic: str = "map"
    track_unknown_space: bool = True
    lethal_cost_threshold: int = 100
    unknown_cost_value: int = -1
    trinary_costmap: bool = True

    def __post_init__(self):
        threshold = self.lethal_cost_threshold
        check(0 < threshold <= 100, "lethal_cost_threshold", "1 to 100", threshold)


def static_costs(cells: np.ndarray, settings: StaticSettings) -> np.ndarray:
    """Costs, uint8 (rows, cols), of a map's cells, int8 (rows, cols)."""
    threshold = settings.lethal_cost_threshold
    if settings.trinary_costmap:
        costs = np.where(cells >= threshold, LETHAL, FREE)
    else:
        costs = np.where(cells >= threshold, LETHAL, LETHAL * cells.astype(np.float64) / threshold)
    unknown = cells == settings.unknown_cost_value
    costs[unknown] = UNKNOWN if settings.track_unknown_space else FREE
    return costs.astype(np.uint8)


def static_costs_in(
    window: Window, frame_in_map: Pose2, grid: OccupancyGrid, costs: np.ndarray
) -> np.ndarray:
    """The map's ``costs`` seen through a window that lies in another frame, uint8 (rows, cols)."""
    corner_in_map = frame_in_map @ Pose2(window.origin_x, window.origin_y)
    corner_in_grid = grid.origin.inverse() @ corner_in_map
    return _seen_through(
        costs,
        corner_in_grid.x / grid.resolution,
        corner_in_grid.y / grid.resolution,
        corner_in_grid.yaw,
        window.resolution / grid.resolution,
        window.rows,
        window.cols,
    )


@numba.njit(cache=True)
def _seen_through(costs, x, y, yaw, scale, rows, cols):
    seen = np.full((rows, cols), UNKNOWN, dtype=np.uint8)
    c, s = math.cos(yaw) * scale, math.sin(yaw) * scale
    for row in range(rows):
        for col in range(cols):
            map_row = math.floor(y + s * (col + 0.5) + c * (row + 0.5))
            map_col = math.floor(x + c * (col + 0.5) - s * (row + 0.5))
            if 0 <= map_row < costs.shape[0] and 0 <= map_col < costs.shape[1]:
                seen[row, col] = costs[map_row, map_col]
    return seen
