"""Combination of a layer's costs with those of the layers below (costmap_2d: CostmapLayer)."""

import numba

from move_base_lite.costmap.costs import UNKNOWN


@numba.njit(cache=True)
def combine(costs, above, bounds, overwrite):
    """Write the higher of both costs, or the upper one; known costs replace unknown ones.

    Args:
        costs: Costs of the layers below, uint8 (rows, cols); changed in place.
        above: Costs of the layer, uint8 (rows, cols).
        bounds: Block of cells to change: first row, row after the last, first column, column after the last.
        overwrite: Whether known costs of the layer replace those below even if these are higher.
    """
    row_min, row_max, col_min, col_max = bounds
    for row in range(row_min, row_max):
        for col in range(col_min, col_max):
            cost = above[row, col]
            if cost == UNKNOWN:
                continue
            if overwrite or costs[row, col] == UNKNOWN or cost > costs[row, col]:
                costs[row, col] = cost
