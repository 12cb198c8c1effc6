"""Inflation layer: costs decay with the distance from obstacles (costmap_2d: InflationLayer)."""

import math
from dataclasses import dataclass

import numba
import numpy as np

from move_base_lite.costmap.costs import FREE, INSCRIBED, LETHAL, UNKNOWN
from move_base_lite.costmap.layer import Layer, LayerContext, LayerSettings
from move_base_lite.costmap.window import CellBounds, CostmapWindow
from planar.config.parameters import at_least, check_parameters, parameter
from planar.extensions import Plugin


@dataclass(frozen=True)
class InflationSettings(LayerSettings):
    """Parameters of costmap_2d's inflation layer."""

    inflation_radius: float = parameter(
        0.55, "distance from obstacles within which cells have costs", "m", at_least(0.0), dynamic=50.0
    )
    cost_scaling_factor: float = parameter(
        10.0, "decay of costs with distance", "1/m", at_least(0.0), dynamic=100.0
    )
    inflate_unknown: bool = parameter(False, "whether unknown cells are inflated too", dynamic=True)

    def __post_init__(self):
        check_parameters(self)


def cost_at(distance: float, inscribed_radius: float, settings: InflationSettings) -> int:
    """Compute the cost of a cell from its distance to the nearest obstacle (costmap_2d: computeCost).

    Args:
        distance: Distance to the obstacle [m], within the reach of inflation.
        inscribed_radius: Inscribed radius of the footprint [m].
        settings: ``cost_scaling_factor``.
    """
    if distance <= 0.0:
        return LETHAL
    if distance <= inscribed_radius:
        return INSCRIBED
    return int((INSCRIBED - 1) * math.exp(-settings.cost_scaling_factor * (distance - inscribed_radius)))


class InflationLayer(Layer):
    """Raises the costs around lethal cells."""

    def __init__(self, settings: InflationSettings, context: LayerContext):
        resolution, inscribed_radius = context.window.resolution, context.footprint.inscribed_radius
        self._inflate_unknown = settings.inflate_unknown
        self.reach_cells = math.ceil(settings.inflation_radius / resolution)
        squares = np.arange(self.reach_cells**2 + 1)
        self._cost_by_square = np.array(
            [cost_at(math.sqrt(square) * resolution, inscribed_radius, settings) for square in squares],
            dtype=np.uint8,
        )

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds: CellBounds) -> None:
        """Inflate obstacles in a block, and those within reach outside of it (see Layer.apply)."""
        if self.reach_cells:
            # numba finds the type of a plain tuple several times as fast as that of a named one.
            cells, source = tuple(bounds), tuple(window.grown(bounds, self.reach_cells))
            far = np.float32(self.reach_cells + 1)
            column_distances = _cells_to_obstacle_along_columns(costs, cells, source, far)
            _inflate(
                costs,
                cells,
                source,
                column_distances,
                self.reach_cells,
                self._cost_by_square,
                self._inflate_unknown,
            )


@numba.njit(cache=True)
def _cells_to_obstacle_along_columns(costs, bounds, source, far):
    """Distances in cells, float32, to the nearest obstacle in the same column, at most ``far``.

    They are for the rows of ``bounds`` and the columns of ``source``.
    """
    row_min, row_max, _, _ = bounds
    source_row_min, source_row_max, col_min, col_max = source
    nearest = np.empty((row_max - row_min, col_max - col_min), dtype=np.float32)
    distances = np.full(col_max - col_min, far)
    for row in range(source_row_min, row_max):
        _pass(costs[row, col_min:col_max], distances, far)
        if row >= row_min:
            nearest[row - row_min] = distances
    distances[:] = far
    for row in range(source_row_max - 1, row_min - 1, -1):
        _pass(costs[row, col_min:col_max], distances, far)
        if row < row_max:
            nearest[row - row_min] = np.minimum(nearest[row - row_min], distances)
    return nearest


@numba.njit(cache=True)
def _pass(costs, distances, far):
    """Propagate the distances to obstacles from one row of costs to the next, at most ``far``."""
    for col in range(costs.size):
        ahead = min(distances[col] + np.float32(1.0), far)
        distances[col] = np.float32(0.0) if costs[col] == LETHAL else ahead


@numba.njit(cache=True)
def _inflate(costs, bounds, source, column_distances, reach, cost_by_square, inflate_unknown):
    """Raise the costs in ``bounds`` by the squared distances to obstacles within ``reach`` cells.

    Each row is shifted over itself: more steps than planar's distance field, but the compiler vectorises
    them, and whole numbers are exact in float32 up to 16 million.
    """
    row_min, row_max, col_min, col_max = bounds
    cols, first, far = col_max - col_min, reach - col_min + source[2], np.float32(cost_by_square.size)
    own, squares = np.full(cols + 2 * reach, far), np.empty(cols, dtype=np.float32)
    for row in range(row_min, row_max):
        own[first : first + column_distances.shape[1]] = (
            column_distances[row - row_min] * column_distances[row - row_min]
        )
        squares[:] = far
        for shift in range(2 * reach + 1):
            aside, shifted = np.float32((shift - reach) ** 2), own[shift : shift + cols]
            for col in range(cols):
                squares[col] = min(squares[col], shifted[col] + aside)
        _raise(costs[row, col_min:col_max], squares, cost_by_square, inflate_unknown)


@numba.njit(cache=True)
def _raise(costs, squares, cost_by_square, inflate_unknown):
    """Raise the costs of a row by the squared distances to obstacles."""
    for col in range(costs.size):
        square = np.int64(squares[col])
        if square >= cost_by_square.size or square == 0:
            continue
        cost = cost_by_square[square]
        if costs[col] == UNKNOWN:
            if cost >= INSCRIBED or (inflate_unknown and cost > FREE):
                costs[col] = cost
        elif cost > costs[col]:
            costs[col] = cost


INFLATION: Plugin[Layer] = Plugin("costmap_2d::InflationLayer", InflationSettings, InflationLayer)
