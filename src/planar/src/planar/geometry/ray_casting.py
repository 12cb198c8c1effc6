"""Ray casting through a grid (Amanatides and Woo, "A fast voxel traversal algorithm", 1987)."""

import math

import numba
import numpy as np

from planar.geometry.grid import OCCUPIED, OccupancyGrid
from planar.geometry.pose import Pose2


def cast_rays(grid: OccupancyGrid, laser_in_map: Pose2, angles: np.ndarray, max_range: float) -> np.ndarray:
    """Cast rays from one pose to the first occupied cell.

    Args:
        grid: Map.
        laser_in_map: Start of the rays.
        angles: Directions in the laser frame [rad], (N,).
        max_range: Result where nothing is hit [m].

    Returns:
        Ranges [m], float64 (N,).
    """
    start = grid.origin.inverse() @ laser_in_map
    return (
        _cast(
            grid.cells,
            start.x / grid.resolution,
            start.y / grid.resolution,
            start.yaw + np.asarray(angles, dtype=np.float64),
            max_range / grid.resolution,
            OCCUPIED,
        )
        * grid.resolution
    )


@numba.njit(cache=True)
def _cast(cells, x, y, angles, max_cells, occupied):
    ranges = np.empty(angles.size)
    for i in range(angles.size):
        ranges[i] = _cast_one(cells, x, y, math.cos(angles[i]), math.sin(angles[i]), max_cells, occupied)
    return ranges


@numba.njit(cache=True)
def _cast_one(cells, x, y, dx, dy, max_cells, occupied):
    rows, cols = cells.shape
    first, last = _span_inside(cols, x, dx)
    first_row, last_row = _span_inside(rows, y, dy)
    first, last = max(first, first_row, 0.0), min(last, last_row, max_cells)
    x, y = (x + first * dx, y + first * dy) if first > 0.0 and first < last else (x, y)
    col, row = math.floor(x), math.floor(y)
    col_step, row_step = (1 if dx > 0 else -1), (1 if dy > 0 else -1)
    col_delta = abs(1.0 / dx) if dx != 0.0 else np.inf
    row_delta = abs(1.0 / dy) if dy != 0.0 else np.inf
    next_col = (col + (dx > 0) - x) / dx if dx != 0.0 else np.inf
    next_row = (row + (dy > 0) - y) / dy if dy != 0.0 else np.inf
    travelled = 0.0
    while first + travelled < last:
        if 0 <= row < rows and 0 <= col < cols and cells[row, col] == occupied:
            return first + travelled
        if next_col < next_row:
            travelled, next_col, col = next_col, next_col + col_delta, col + col_step
        else:
            travelled, next_row, row = next_row, next_row + row_delta, row + row_step
    return max_cells


@numba.njit(cache=True)
def _span_inside(cells, start, step):
    """Return the part of a ray, in cells, in which one coordinate is in the grid, with a small margin."""
    if step == 0.0:
        return (-np.inf, np.inf) if -1.0 <= start <= cells + 1.0 else (np.inf, -np.inf)
    one, other = -start / step, (cells - start) / step
    return min(one, other) - 2.0, max(one, other) + 2.0


def cast_rays_from_many(
    grid: OccupancyGrid, lasers_in_map: np.ndarray, angles: np.ndarray, max_range: float
) -> np.ndarray:
    """Cast rays from many poses.

    Args:
        grid: Map.
        lasers_in_map: Poses, (N, 3) ``[x, y, yaw]``.
        angles: Directions in the frame of each pose [rad], (M,).
        max_range: Result where nothing is hit [m].

    Returns:
        Ranges [m], float64 (N, M).
    """
    in_grid = np.empty((len(lasers_in_map), 3))
    in_grid[:, :2] = grid.origin.inverse().transform_points(lasers_in_map[:, :2]) / grid.resolution
    in_grid[:, 2] = lasers_in_map[:, 2] - grid.origin.yaw
    angles = np.asarray(angles, dtype=np.float64)
    return (
        _cast_from_many(grid.cells, in_grid, angles, max_range / grid.resolution, OCCUPIED) * grid.resolution
    )


@numba.njit(cache=True)
def _cast_from_many(cells, poses, angles, max_cells, occupied):
    ranges = np.empty((poses.shape[0], angles.size))
    for i in range(poses.shape[0]):
        x, y, yaw = poses[i]
        ranges[i] = _cast(cells, x, y, yaw + angles, max_cells, occupied)
    return ranges
