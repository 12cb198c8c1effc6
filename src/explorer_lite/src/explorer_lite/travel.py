"""Path lengths from the robot to all cells that it can reach."""

import heapq
import math
from typing import Optional, Tuple

import numba
import numpy as np

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2

# Radius around the robot in which paths may start with less clearance [m], and the share of it needed.
ESCAPE_RADIUS = 1.0
ESCAPE_CLEARANCE_SHARE = 0.6


def travel_distances(
    grid: OccupancyGrid, obstacle_distance: np.ndarray, robot: Pose2, clearance: float
) -> np.ndarray:
    """Compute the path length from the robot to each cell.

    Paths lead through known free cells with more than ``clearance``. Within ESCAPE_RADIUS of the robot,
    unknown cells and less clearance are accepted: the laser may not see the floor around the robot.

    Args:
        grid: Free, occupied and unknown cells.
        obstacle_distance: Distance (rows, cols) to the nearest obstacle [m].
        robot: Robot pose in the grid's frame.
        clearance: Least distance to obstacles along a path [m].

    Returns:
        Distances (rows, cols) [m], float32, inf for unreachable cells.
    """
    passable = (grid.cells == FREE) & (obstacle_distance > clearance)
    near = _cells_near(grid, robot)
    passable[near] |= (grid.cells[near] != OCCUPIED) & (
        obstacle_distance[near] > ESCAPE_CLEARANCE_SHARE * clearance
    )
    start = _nearest_passable(grid, passable, robot)
    if start is None:
        return np.full(grid.cells.shape, np.inf, dtype=np.float32)
    return _dijkstra(passable, *start) * np.float32(grid.resolution)


def _cells_near(grid, robot) -> Tuple[slice, slice]:
    ((row, col),) = grid.cells_of([[robot.x, robot.y]])
    reach = math.ceil(ESCAPE_RADIUS / grid.resolution)
    return slice(max(row - reach, 0), max(row + reach + 1, 0)), slice(
        max(col - reach, 0), max(col + reach + 1, 0)
    )


def _nearest_passable(grid, passable, robot) -> Optional[Tuple[int, int]]:
    cells = np.argwhere(passable)
    if len(cells) == 0:
        return None
    distances = np.hypot(*(grid.points_of(cells) - [robot.x, robot.y]).T)
    best = int(np.argmin(distances))
    return (int(cells[best, 0]), int(cells[best, 1])) if distances[best] <= ESCAPE_RADIUS else None


@numba.njit(cache=True)
def _dijkstra(passable, start_row, start_col):
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
