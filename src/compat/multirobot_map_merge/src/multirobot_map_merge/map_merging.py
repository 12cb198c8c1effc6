"""Merging of occupancy grids with known relative poses."""

import math
from typing import Sequence, Tuple

import numpy as np

from planar import OCCUPIED, UNKNOWN, OccupancyGrid, PlanarError, Pose2

# Limit of the merged grid, so that a wrong pose does not exhaust the memory.
MAX_CELLS = 100_000_000


def merge_maps(grids: Sequence[Tuple[Pose2, OccupancyGrid]]) -> OccupancyGrid:
    """Merge occupancy grids; where two grids know a cell, the more occupied value is used.

    Args:
        grids: Pose of each grid's frame in the world, and the grid.

    Returns:
        A grid along the axes of the world, with the finest resolution of the grids.

    Raises:
        PlanarError: The merged grid would have more than MAX_CELLS cells.
    """
    resolution = min(grid.resolution for _, grid in grids)
    corners = np.vstack([_corners(frame_in_world, grid) for frame_in_world, grid in grids])
    low = np.floor(corners.min(axis=0) / resolution) * resolution
    cols, rows = (int(math.ceil(float(side))) for side in (corners.max(axis=0) - low) / resolution)
    if rows * cols > MAX_CELLS:
        raise PlanarError(f"the merged map would have {rows} x {cols} cells")
    cells = np.full((rows, cols), UNKNOWN, dtype=np.int8)
    merged = OccupancyGrid(cells, resolution, Pose2(float(low[0]), float(low[1])))
    for frame_in_world, grid in grids:
        _merge_into(merged, frame_in_world, grid)
    return merged


def _corners(frame_in_world: Pose2, grid: OccupancyGrid) -> np.ndarray:
    """Corners of a grid: (4, 2), metres, in the world."""
    width, height = grid.cols * grid.resolution, grid.rows * grid.resolution
    ends = [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)]
    poses = [frame_in_world @ grid.origin @ Pose2(x, y) for x, y in ends]
    return np.array([(pose.x, pose.y) for pose in poses])


def _merge_into(merged: OccupancyGrid, frame_in_world: Pose2, grid: OccupancyGrid) -> None:
    corners = merged.cells_of(_corners(frame_in_world, grid))
    (row0, col0), (row1, col1) = corners.min(axis=0), corners.max(axis=0) + 1
    rows, cols = np.mgrid[max(row0, 0) : min(row1, merged.rows), max(col0, 0) : min(col1, merged.cols)]
    at = np.column_stack((rows.ravel(), cols.ravel()))
    points = merged.points_of(at)
    back = frame_in_world.inverse()
    c, s = math.cos(back.yaw), math.sin(back.yaw)
    inside_xy = points @ np.array([(c, s), (-s, c)]) + (back.x, back.y)
    cells_of_grid = grid.cells_of(inside_xy)
    is_inside = grid.contains(cells_of_grid)
    at, cells_of_grid = at[is_inside], cells_of_grid[is_inside]
    values = np.minimum(grid.cells[cells_of_grid[:, 0], cells_of_grid[:, 1]], OCCUPIED)
    into = merged.cells
    into[at[:, 0], at[:, 1]] = np.maximum(into[at[:, 0], at[:, 1]], values)
