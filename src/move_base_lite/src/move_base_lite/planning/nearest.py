"""Replacement of a blocked start or goal by the nearest passable cell."""

import math
from typing import Optional, Tuple

import numpy as np

from move_base_lite.planning.wavefront import IMPASSABLE

Cell = Tuple[int, int]


def passable_ends(
    traversal: np.ndarray, start: Cell, goal: Cell, start_reach: float, goal_reach: float
) -> Tuple[Optional[Cell], Optional[Cell]]:
    """Replace start and goal by the nearest passable cells.

    Replacements that are connected to the other end are preferred: the nearest cell may be enclosed, for
    example inside a cupboard.

    Args:
        traversal: (rows, cols) traversal costs.
        start: Row and column.
        goal: Row and column.
        start_reach: Maximum distance of a replaced start [cells].
        goal_reach: Maximum distance of a replaced goal [cells].

    Returns:
        Start and goal, each None if there is no passable cell within reach.
    """
    passable = traversal < IMPASSABLE
    free_start, free_goal = _nearest(passable, start, start_reach), _nearest(passable, goal, goal_reach)
    if free_start is None or free_goal is None or (free_start == start and free_goal == goal):
        return free_start, free_goal
    from scipy.ndimage import label  # imported late: slow to import, rarely needed

    regions, _ = label(passable)
    if free_goal != goal:
        free_goal = _nearest(regions == regions[free_start], goal, goal_reach) or free_goal
    if free_start != start and regions[free_start] != regions[free_goal]:
        free_start = _nearest(regions == regions[free_goal], start, start_reach) or free_start
    return free_start, free_goal


def _nearest(allowed: np.ndarray, cell: Cell, reach: float) -> Optional[Cell]:
    """The cell itself if it is allowed, else the nearest that is, else None."""
    row, col = cell
    if allowed[row, col]:
        return cell
    side = math.floor(reach)
    row_min, col_min = max(row - side, 0), max(col - side, 0)
    rows, cols = np.nonzero(allowed[row_min : row + side + 1, col_min : col + side + 1])
    squares = (rows + row_min - row) ** 2 + (cols + col_min - col) ** 2
    within = squares <= reach**2
    if not within.any():
        return None
    best = int(np.argmin(np.where(within, squares, squares.max() + 1)))
    return int(rows[best]) + row_min, int(cols[best]) + col_min
