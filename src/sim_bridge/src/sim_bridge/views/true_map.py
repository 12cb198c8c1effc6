"""The exact occupancy grid of a world cut at a height: the map a perfect mapper would make."""

import math
from typing import List, Tuple

import numpy as np

from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, Pose2
from sim_bridge.errors import WorldError
from sim_bridge.geometry.slicing import slice_shape
from sim_bridge.world import World

# A solid that reaches less far than this, in cells, into a cell only touches it (1.5708 is not quite pi/2).
TOUCH = 0.02


def true_map(
    world: World,
    height: float = 0.3,
    resolution: float = 0.05,
    inside: Tuple[float, float] = (0.0, 0.0),
    thickness: float = 0.01,
    margin: float = 0.5,
) -> OccupancyGrid:
    """The grid of what is solid within ``thickness`` metres about ``height``.

    Cells that a solid overlaps are occupied, those that can be reached from the point ``inside`` without
    crossing one are free, all others unknown. The grid reaches ``margin`` metres beyond the outermost solid;
    its origin is a multiple of the resolution. Raises WorldError if there is nothing at that height or
    ``inside`` lies in a solid.
    """
    bottom, top = height - thickness / 2.0, height + thickness / 2.0
    outlines = outlines_of(world, bottom, top)
    if not outlines:
        raise WorldError(f"world '{world.name}': nothing is solid at a height of {height:g} m")
    corners = np.vstack([*outlines, [inside]])
    first = np.floor((corners.min(axis=0) - margin) / resolution).astype(int)
    last = np.ceil((corners.max(axis=0) + margin) / resolution).astype(int)
    cols, rows = last - first
    origin = Pose2(*(first * resolution).tolist())
    solid = np.zeros((rows, cols), dtype=bool)
    for outline in outlines:
        _fill(solid, outline / resolution - first)
    cells = np.full(solid.shape, UNKNOWN, dtype=np.int8)
    grid = OccupancyGrid(cells, resolution, origin)
    ((row, col),) = grid.cells_of([inside])
    if solid[row, col]:
        raise WorldError(f"world '{world.name}': ({inside[0]:g}, {inside[1]:g}) is not free space")
    from scipy.ndimage import label  # late: a simulation needs no map

    regions, _ = label(~solid)
    cells[regions == regions[row, col]] = FREE
    cells[solid] = OCCUPIED
    return grid


def outlines_of(world: World, bottom: float, top: float) -> List[np.ndarray]:
    """The convex outlines (N, 2) of all that is solid and stays, between two heights, metres."""
    return [
        outline
        for body in world.bodies
        if not body.is_kinematic
        for part in body.collisions
        for outline in slice_shape(part.shape, body.pose_in_world @ part.pose_in_body, bottom, top)
    ]


def _fill(solid: np.ndarray, outline: np.ndarray) -> None:
    """Sets the cells that a convex outline (N, 2), in cells from the grid's corner, overlaps.

    A cell is missed if some direction separates it from the outline: its own axes or an edge's normal
    (separating axis theorem).
    """
    low = np.maximum(np.floor(outline.min(axis=0)).astype(int) - 1, 0)
    high = np.ceil(outline.max(axis=0)).astype(int) + 1
    col, row = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
    edges = np.roll(outline, -1, axis=0) - outline
    overlaps = np.ones(col.shape, dtype=bool)
    for x, y in [(1.0, 0.0), (0.0, 1.0), *zip(-edges[:, 1], edges[:, 0])]:
        along = outline @ (x, y)
        first, last = along.min(), along.max()
        touch = min(TOUCH * math.hypot(x, y), (last - first) / 4.0)
        corner = col * x + row * y
        overlaps &= corner + min(x, 0.0) + min(y, 0.0) <= last - touch
        overlaps &= corner + max(x, 0.0) + max(y, 0.0) >= first + touch
    solid[low[1] : high[1], low[0] : high[0]] |= overlaps[
        : solid.shape[0] - low[1], : solid.shape[1] - low[0]
    ]
