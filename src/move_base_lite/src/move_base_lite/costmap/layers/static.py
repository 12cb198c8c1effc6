"""The map as a layer of a costmap (costmap_2d's static layer)."""

import math
from dataclasses import dataclass
from typing import Optional

import numba
import numpy as np

from move_base_lite.costmap.costs import FREE, LETHAL, UNKNOWN
from move_base_lite.costmap.layer import Layer, LayerSettings, Placement, Site
from move_base_lite.costmap.window import NO_CELLS, Bounds, Window
from move_base_lite.plugin import Plugin
from planar import OccupancyGrid, Pose2
from planar.config.parameters import Bounds as Values
from planar.config.parameters import check_parameters, parameter


@dataclass(frozen=True)
class StaticSettings(LayerSettings):
    """costmap_2d's parameters of it."""

    map_topic: str = parameter("map", "where the map comes from")
    track_unknown_space: bool = parameter(
        True, "whether the map's unknown cells are unknown rather than free"
    )
    lethal_cost_threshold: int = parameter(
        100, "occupancy from which on a cell is an obstacle", bounds=Values(1, 100, "1 to 100")
    )
    unknown_cost_value: int = parameter(-1, "occupancy that means a cell of which nothing is known")
    trinary_costmap: bool = parameter(True, "obstacle, free or unknown, nothing in between")

    def __post_init__(self):
        check_parameters(self)


class StaticLayer(Layer):
    """The map, as it lies in a fixed costmap or as it is seen through a rolling window."""

    def __init__(self, settings: StaticSettings, site: Site):
        self._grid, self._is_rolling = site.grid, site.is_rolling
        self._costs: Optional[np.ndarray] = None
        if site.grid is not None:
            self._map_costs = static_costs(site.grid.cells, settings)
            if not site.is_rolling:
                self._costs = self._map_costs

    def update(self, placement: Placement) -> Bounds:
        if self._grid is None or not self._is_rolling:
            return NO_CELLS
        window, frame_in_map = placement.window, placement.map_in_frame.inverse()
        self._costs = static_costs_in(window, frame_in_map, self._grid, self._map_costs)
        return window.everything

    def apply(self, costs: np.ndarray, window: Window, bounds: Bounds) -> None:
        if self._costs is not None:
            rows, cols = bounds.slices
            costs[rows, cols] = self._costs[rows, cols]


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


STATIC: Plugin[Layer] = Plugin(
    "costmap_2d::StaticLayer",
    StaticSettings,
    StaticLayer,
    ignored=frozenset({"first_map_only", "subscribe_to_updates", "use_maximum"}),
)
