"""Several grids, whose places are known, made into one."""

import math
from typing import Sequence, Tuple

import numpy as np

from planar import OCCUPIED, UNKNOWN, OccupancyGrid, PlanarError, Pose2

# Of the merged grid, so that no robot that has lost itself makes it take all memory.
MAX_CELLS = 100_000_000


def merge_maps(grids: Sequence[Tuple[Pose2, OccupancyGrid]]) -> OccupancyGrid:
    """The grid of all that is known to any of the ``grids``, each with where its frame lies in the world.

    As fine as the finest, along the world's axes; of two that know a cell the more occupied is believed.
    Raises PlanarError if it would be too large.
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
    """(4, 2), in the world."""
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
    seen = grid.cells_of(inside_xy)
    is_there = grid.contains(seen)
    at, seen = at[is_there], seen[is_there]
    values = np.minimum(grid.cells[seen[:, 0], seen[:, 1]], OCCUPIED)
    into = merged.cells
    into[at[:, 0], at[:, 1]] = np.maximum(into[at[:, 0], at[:, 1]], values)
