"""How far it is to everywhere that a robot can get."""

import heapq
import math
from typing import Optional, Tuple

import numba
import numpy as np

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2

SET_OUT_RADIUS = 1.0
SET_OUT_SHARE = 0.6


def travel_distances(grid: OccupancyGrid, room: np.ndarray, robot: Pose2, clearance: float) -> np.ndarray:
    """Length of the way, metres, from the robot to each cell: float32 (rows, cols), inf where there is none.

    ``room``: (rows, cols), metres to the next obstacle. The way leads through known free cells with more than
    ``clearance`` of it. The first metre is judged more kindly: there the robot, which got there, may leave
    through the unknown (its laser may not see the floor around it) and with less room.
    """
    passable = (grid.cells == FREE) & (room > clearance)
    near = _cells_near(grid, robot)
    passable[near] |= (grid.cells[near] != OCCUPIED) & (room[near] > SET_OUT_SHARE * clearance)
    start = _nearest_passable(grid, passable, robot)
    if start is None:
        return np.full(grid.cells.shape, np.inf, dtype=np.float32)
    return _spread(passable, *start) * np.float32(grid.resolution)


def _cells_near(grid, robot) -> Tuple[slice, slice]:
    ((row, col),) = grid.cells_of([[robot.x, robot.y]])
    reach = math.ceil(SET_OUT_RADIUS / grid.resolution)
    return slice(max(row - reach, 0), max(row + reach + 1, 0)), slice(
        max(col - reach, 0), max(col + reach + 1, 0)
    )


def _nearest_passable(grid, passable, robot) -> Optional[Tuple[int, int]]:
    cells = np.argwhere(passable)
    if len(cells) == 0:
        return None
    distances = np.hypot(*(grid.points_of(cells) - [robot.x, robot.y]).T)
    best = int(np.argmin(distances))
    return (int(cells[best, 0]), int(cells[best, 1])) if distances[best] <= SET_OUT_RADIUS else None


@numba.njit(cache=True)
def _spread(passable, start_row, start_col):
    """Dijkstra's algorithm on cells with eight neighbours, not cutting corners; distances in cells."""
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
                if not (passable[row, next_col] and passable[next_row, col]):
                    continue
                reached = np.float32(distance + math.sqrt(row_step * row_step + col_step * col_step))
                if reached < distances[next_row, next_col]:
                    distances[next_row, next_col] = reached
                    heapq.heappush(waiting, (reached, next_row, next_col))
    return distances
