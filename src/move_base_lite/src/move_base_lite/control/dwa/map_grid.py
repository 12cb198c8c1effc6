"""Distances through free cells to the plan or to its end (base_local_planner's MapGrid)."""

import math

import numba
import numpy as np

from move_base_lite.costmap import INSCRIBED, CostmapWindow

UNREACHABLE = 1e6
DIAGONAL = math.sqrt(2.0)


def distances_to(costs: np.ndarray, window: CostmapWindow, targets_xy: np.ndarray) -> np.ndarray:
    """Path length from each free cell to the nearest target.

    Paths have eight directions and avoid cells nearer to an obstacle than the inscribed radius.

    Args:
        costs: (rows, cols), uint8.
        window: Position and resolution of the grid.
        targets_xy: (N, 2) in the window's frame [m]; those outside of the window are ignored.

    Returns:
        Distances (rows, cols) in cells, float32, UNREACHABLE where no path leads to a target.
    """
    cells = (targets_xy - (window.origin_x, window.origin_y)) / window.resolution
    return _distances(costs, np.floor(cells).astype(np.int64))


@numba.njit(cache=True)
def _distances(costs, target_cells):
    rows, cols = costs.shape
    size = rows * cols
    distances = np.full((rows, cols), UNREACHABLE, dtype=np.float32)
    queue = np.empty(size + 1, dtype=np.int32)
    queued = np.zeros(size, dtype=np.bool_)
    head, tail = 0, 0
    for i in range(target_cells.shape[0]):
        col, row = target_cells[i, 0], target_cells[i, 1]
        if 0 <= row < rows and 0 <= col < cols and not queued[row * cols + col]:
            distances[row, col] = 0.0
            queued[row * cols + col] = True
            queue[tail] = row * cols + col
            tail += 1
    while head != tail:
        cell = queue[head]
        head = head + 1 if head < size else 0
        queued[cell] = False
        row, col = cell // cols, cell % cols
        for row_step in range(-1, 2):
            for col_step in range(-1, 2):
                r, c = row + row_step, col + col_step
                if r < 0 or r >= rows or c < 0 or c >= cols or costs[r, c] >= INSCRIBED:
                    continue
                step = DIAGONAL if row_step != 0 and col_step != 0 else 1.0
                reached = np.float32(distances[row, col] + step)
                if reached < distances[r, c]:
                    distances[r, c] = reached
                    if not queued[r * cols + c]:
                        queued[r * cols + c] = True
                        queue[tail] = r * cols + c
                        tail = tail + 1 if tail < size else 0
    return distances
