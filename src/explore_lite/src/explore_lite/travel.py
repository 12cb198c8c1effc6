"""How far it is to everywhere that a robot can get."""

import heapq
import math
from typing import Optional, Tuple

import numba
import numpy as np

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2
from planar.distance_field import distance_field

SET_OUT_RADIUS = 1.0


def travel_distances(grid: OccupancyGrid, robot: Pose2, clearance: float) -> np.ndarray:
    """Length of the way, metres, from the robot to each cell: float32 (rows, cols), inf where there is none.

    The way leads through known free cells with ``clearance`` metres to the next obstacle; the robot itself
    may stand up to a metre beside such a cell.
    """
    passable = (grid.cells == FREE) & (distance_field(grid.cells == OCCUPIED, grid.resolution) > clearance)
    start = _nearest_passable(grid, passable, robot)
    if start is None:
        return np.full(grid.cells.shape, np.inf, dtype=np.float32)
    return _spread(passable, *start) * np.float32(grid.resolution)


def _nearest_passable(grid, passable, robot) -> Optional[Tuple[int, int]]:
    cells = np.argwhere(passable)
    if len(cells) == 0:
        return None
    distances = np.hypot(*(grid.points_of(cells) - [robot.x, robot.y]).T)
    best = int(np.argmin(distances))
    return (int(cells[best, 0]), int(cells[best, 1])) if distances[best] <= SET_OUT_RADIUS else None


@numba.njit(cache=True)
def _spread(passable, start_row, start_col):
    """Dijkstra's algorithm on cells with eight neighbours; distances in cells."""
    rows, cols = passable.shape
    distances = np.full((rows, cols), np.inf, dtype=np.float32)
    distances[start_row, start_col] = 0.0
    waiting = [(np.float32(0.0), start_row, start_col)]
    while len(waiting) > 0:
        distance, row, col = heapq.heappop(waiting)
        if distance > distances[row, col]:
            continue
        for row_step in (-1, 0, 1):
            for col_step in (-1, 0, 1):
                next_row, next_col = row + row_step, col + col_step
                if not (0 <= next_row < rows and 0 <= next_col < cols and passable[next_row, next_col]):
                    continue
                reached = np.float32(distance + math.sqrt(row_step * row_step + col_step * col_step))
                if reached < distances[next_row, next_col]:
                    distances[next_row, next_col] = reached
                    heapq.heappush(waiting, (reached, next_row, next_col))
    return distances
