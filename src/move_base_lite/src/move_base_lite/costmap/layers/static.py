"""Static layer: a map (costmap_2d: StaticLayer)."""

import math
from dataclasses import dataclass, replace

import numba
import numpy as np

from move_base_lite.costmap.combination import combine
from move_base_lite.costmap.costs import FREE, LETHAL, UNKNOWN
from move_base_lite.costmap.layer import CostmapPlacement, Layer, LayerContext, LayerSettings
from move_base_lite.costmap.static_maps import StaticMapSource
from move_base_lite.costmap.window import NO_CELLS, CellBounds, CostmapWindow
from planar import OccupancyGrid, Pose2
from planar.config.parameters import check_parameters, parameter
from planar.extensions import Plugin


@dataclass(frozen=True)
class StaticSettings(LayerSettings):
    """Parameters of costmap_2d's static layer."""

    map_topic: str = parameter("map", "topic of the map")
    first_map_only: bool = parameter(False, "whether later maps on the topic are ignored")
    subscribe_to_updates: bool = parameter(
        False, "whether changes of the map on the topic with the suffix _updates are applied"
    )
    track_unknown_space: bool = parameter(
        True, "whether the map's unknown cells are unknown rather than free"
    )
    use_maximum: bool = parameter(
        False, "keep the higher cost of this layer and those below instead of replacing them"
    )
    lethal_cost_threshold: int = parameter(
        100, "occupancy from which on a cell is an obstacle, at least 0 and at most 100"
    )
    unknown_cost_value: int = parameter(-1, "occupancy of unknown cells")
    trinary_costmap: bool = parameter(
        True, "whether cells are obstacle, free or unknown, without values in between"
    )

    def __post_init__(self):
        check_parameters(self)

    @property
    def source(self) -> StaticMapSource:
        """Where the layer has its map from."""
        return StaticMapSource(self.map_topic, self.first_map_only, self.subscribe_to_updates)


class StaticLayer(Layer):
    """Writes its map into the costmap, cell by cell if both have the same cells, else resampled.

    A map in the frame of a rolling costmap lies fixed in it, any other one is transformed from the map frame
    at each update.
    """

    def __init__(self, settings: StaticSettings, context: LayerContext):
        self._keeps_higher, self._is_rolling = settings.use_maximum, context.is_rolling
        found = context.find_map(settings.source)
        self._has_map = found is not None
        self._frame_in_map = Pose2()
        if found is not None:
            self._is_fixed = not context.is_rolling or found.frame == context.global_frame
            self._grid = found.grid
            self._costs = static_costs(found.grid.cells, settings)

    def update(self, placement: CostmapPlacement) -> CellBounds:
        if not (self._has_map and self._is_rolling):
            return NO_CELLS
        if not self._is_fixed:
            self._frame_in_map = placement.map_in_frame.inverse()
        return placement.window.everything

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds: CellBounds) -> None:
        if not self._has_map:
            return
        if not self._is_rolling and window == window_of_map(self._grid) and not self._grid.origin.yaw:
            if self._keeps_higher:
                combine(costs, self._costs, tuple(bounds), False)
            else:
                costs[bounds.slices] = self._costs[bounds.slices]
            return
        resolution = self._grid.resolution
        corner_in_map = self._frame_in_map @ Pose2(window.origin_x, window.origin_y)
        corner = self._grid.origin.inverse() @ corner_in_map
        position = corner.x / resolution, corner.y / resolution, corner.yaw, window.resolution / resolution
        _sample(costs, tuple(bounds), self._costs, position, self._keeps_higher)


def window_of_map(grid: OccupancyGrid) -> CostmapWindow:
    """Return the smallest window that contains a map, with its cells unless the map is rotated."""
    window = CostmapWindow(grid.rows, grid.cols, grid.resolution, grid.origin.x, grid.origin.y)
    if not grid.origin.yaw:
        return window
    width, height = grid.cols * grid.resolution, grid.rows * grid.resolution
    corners_xy = grid.origin.transform_points(
        np.array([(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)])
    )
    low, high = corners_xy.min(axis=0), corners_xy.max(axis=0)
    cols, rows = np.ceil((high - low) / grid.resolution - 1e-9).astype(int)
    return replace(window, rows=int(rows), cols=int(cols), origin_x=float(low[0]), origin_y=float(low[1]))


def static_costs(cells: np.ndarray, settings: StaticSettings) -> np.ndarray:
    """Convert occupancy values of a map to costs.

    As in costmap_2d the values count as unsigned: -1 is 255, so it is an obstacle where another value means
    unknown.

    Args:
        cells: int8 (rows, cols), 0 to 100, or -1 for unknown.
        settings: Thresholds of the static layer.

    Returns:
        uint8 (rows, cols).
    """
    values, threshold = np.arange(256), min(max(settings.lethal_cost_threshold, 0), 100)
    if settings.trinary_costmap:
        costs = np.where(values >= threshold, LETHAL, FREE)
    else:
        costs = np.where(values >= threshold, LETHAL, LETHAL * (values / max(threshold, 1)))
    costs[settings.unknown_cost_value & 255] = UNKNOWN if settings.track_unknown_space else FREE
    return costs.astype(np.uint8)[cells.view(np.uint8)]


@numba.njit(cache=True)
def _sample(costs, bounds, map_costs, position, keeps_higher):
    """Write the costs of a map at the centres of the cells; cells outside the map stay.

    ``position`` is that of the costs' corner in the map's cells, x, y, yaw, and the ratio of cell sizes.
    """
    row_min, row_max, col_min, col_max = bounds
    x, y, yaw, scale = position
    c, s = math.cos(yaw) * scale, math.sin(yaw) * scale
    for row in range(row_min, row_max):
        for col in range(col_min, col_max):
            map_row = math.floor(y + s * (col + 0.5) + c * (row + 0.5))
            map_col = math.floor(x + c * (col + 0.5) - s * (row + 0.5))
            if 0 <= map_row < map_costs.shape[0] and 0 <= map_col < map_costs.shape[1]:
                cost = map_costs[map_row, map_col]
                is_kept = keeps_higher and (
                    cost == UNKNOWN or (costs[row, col] != UNKNOWN and cost <= costs[row, col])
                )
                if not is_kept:
                    costs[row, col] = cost


STATIC: Plugin[Layer] = Plugin("costmap_2d::StaticLayer", StaticSettings, StaticLayer)
