"""Inflation: what lies near an obstacle costs the more the nearer it is (costmap_2d's inflation layer)."""

import math
from dataclasses import dataclass

import numba
import numpy as np

from move_base_lite.costmap.costs import FREE, INSCRIBED, LETHAL, UNKNOWN
from move_base_lite.costmap.window import Bounds, Window
from planar.config.settings import check


@dataclass(frozen=True)
class InflationSettings:
    enabled: bool = True
    inflation_radius: float = 0.55
    cost_scaling_factor: float = 10.0
    inflate_unknown: bool = False

    def __post_init__(self):
        check(self.inflation_radius >= 0.0, "inflation_radius", "at least 0", self.inflation_radius)
        check(self.cost_scaling_factor >= 0.0, "cost_scaling_factor", "at least 0", self.cost_scaling_factor)


def cost_at(distance: float, inscribed_radius: float, settings: InflationSettings) -> int:
    """Cost of a cell so many metres from the nearest obstacle."""
    if distance <= 0.0:
        return LETHAL
    if distance > settings.inflation_radius:
        return FREE
    if distance <= inscribed_radius:
        return INSCRIBED
    return int((INSCRIBED - 1) * math.exp(-settings.cost_scaling_factor * (distance - inscribed_radius)))


class Inflation:
    """Raises the costs around lethal cells, within any block of a costmap."""

    def __init__(self, settings: InflationSettings, inscribed_radius: float, resolution: float):
        self._inflate_unknown = settings.inflate_unknown
        self.reach_cells = math.ceil(settings.inflation_radius / resolution) if settings.enabled else 0
        squares = np.arange(self.reach_cells**2 + 1)
        self._cost_by_square = np.array(
            [cost_at(math.sqrt(square) * resolution, inscribed_radius, settings) for square in squares],
            dtype=np.uint8,
        )

    def apply(self, costs: np.ndarray, window: Window, bounds: Bounds) -> None:
        """Inflates the cells of ``bounds`` in place; obstacles in reach outside of it count too."""
        if self.reach_cells:
            seen = window.grown(bounds, self.reach_cells)
            _inflate(costs, bounds, seen, self.reach_cells, self._cost_by_square, self._inflate_unknown)


@numba.njit(cache=True)
def _inflate(costs, bounds, seen, reach, cost_by_square, inflate_unknown):
    """Exact Euclidean distances in two passes (Felzenszwalb and Huttenlocher, 2012), cut off at ``reach``."""
    row_min, row_max, col_min, col_max = bounds
    seen_row_min, seen_row_max, seen_col_min, seen_col_max = seen
    far = reach + 1
    along = np.full((row_max - row_min, seen_col_max - seen_col_min), far, dtype=np.int32)
    for col in range(seen_col_min, seen_col_max):
        distance = far
        for row in range(seen_row_min, row_max):
            distance = 0 if costs[row, col] == LETHAL else min(distance + 1, far)
            if row >= row_min:
                along[row - row_min, col - seen_col_min] = distance
        distance = far
        for row in range(seen_row_max - 1, row_min - 1, -1):
            distance = 0 if costs[row, col] == LETHAL else min(distance + 1, far)
            if row < row_max and distance < along[row - row_min, col - seen_col_min]:
                along[row - row_min, col - seen_col_min] = distance
    for row in range(row_min, row_max):
        nearest_in_col = along[row - row_min]
        for col in range(col_min, col_max):
            middle = col - seen_col_min
            best = nearest_in_col[middle] ** 2
            for offset in range(1, far):
                square = offset * offset
                if square >= best:
                    break
                if middle - offset >= 0:
                    best = min(best, square + nearest_in_col[middle - offset] ** 2)
                if middle + offset < nearest_in_col.size:
                    best = min(best, square + nearest_in_col[middle + offset] ** 2)
            if best >= cost_by_square.size or best == 0:
                continue
            cost = cost_by_square[best]
            if costs[row, col] == UNKNOWN:
                if cost >= INSCRIBED or (inflate_unknown and cost > FREE):
                    costs[row, col] = cost
            elif cost > costs[row, col]:
                costs[row, col] = cost
