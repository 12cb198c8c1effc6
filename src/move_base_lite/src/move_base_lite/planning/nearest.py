"""The nearest cell on which the robot can stand."""

import math
from typing import Optional, Tuple

import numpy as np

from move_base_lite.planning.wavefront import IMPASSABLE


def nearest_passable(
    traversal: np.ndarray, cell: Tuple[int, int], tolerance_cells: float
) -> Optional[Tuple[int, int]]:
    """The cell itself if it can be entered, else the nearest that can within the tolerance, else None."""
    row, col = cell
    if traversal[row, col] < IMPASSABLE:
        return cell
    reach = math.floor(tolerance_cells)
    row_min, col_min = max(row - reach, 0), max(col - reach, 0)
    block = traversal[row_min : row + reach + 1, col_min : col + reach + 1]
    rows, cols = np.nonzero(block < IMPASSABLE)
    squares = (rows + row_min - row) ** 2 + (cols + col_min - col) ** 2
    within = squares <= tolerance_cells**2
    if not within.any():
        return None
    best = int(np.argmin(np.where(within, squares, squares.max() + 1)))
    return int(rows[best]) + row_min, int(cols[best]) + col_min
