"""Ground-truth occupancy grid of a world at one height."""

import math
from typing import List, Sequence, Tuple

import numpy as np

from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, Pose2
from sim_bridge.errors import WorldError
from sim_bridge.geometry.slicing import slice_shape
from sim_bridge.world import World

# A solid that reaches into a cell by less than this does not occupy it [cells]: 1.5708 is not quite pi/2.
TOUCH = 0.02


def true_map(
    world: World,
    height: float = 0.3,
    resolution: float = 0.05,
    inside: Tuple[float, float] = (0.0, 0.0),
    thickness: float = 0.01,
    margin: float = 0.5,
) -> OccupancyGrid:
    """Return the ground-truth map of a world.

    Cells that a solid overlaps are occupied, those that are connected to ``inside`` are free, all others are
    unknown. The grid's origin is a multiple of the resolution.

    Args:
        world: The world; its dynamic obstacles are left out.
        height: Height of the slice [m].
        resolution: Size of a cell [m].
        inside: A point in free space [m].
        thickness: Thickness of the slice [m].
        margin: Distance by which the grid extends beyond the outermost solid [m].

    Raises:
        WorldError: Nothing is solid at that height, or ``inside`` is in a solid.
    """
    bottom, top = height - thickness / 2.0, height + thickness / 2.0
    outlines = outlines_of(world, bottom, top)
    if not outlines:
        raise WorldError(f"world '{world.name}': nothing is solid at a height of {height:g} m")
    solid, origin = _occupied_cells(outlines, inside, resolution, margin)
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


def _occupied_cells(
    outlines: Sequence[np.ndarray], inside: Tuple[float, float], resolution: float, margin: float
) -> Tuple[np.ndarray, Pose2]:
    """Return which cells (rows, cols) convex outlines overlap, and the origin of the grid."""
    corners = np.vstack([*outlines, [inside]])
    first = np.floor((corners.min(axis=0) - margin) / resolution).astype(int)
    last = np.ceil((corners.max(axis=0) + margin) / resolution).astype(int)
    cols, rows = last - first
    origin = Pose2(*(first * resolution).tolist())
    solid = np.zeros((rows, cols), dtype=bool)
    for outline in outlines:
        _fill(solid, outline / resolution - first)
    return solid, origin


def outlines_of(world: World, bottom: float, top: float) -> List[np.ndarray]:
    """Return convex outlines of all solids that do not move, cut between two heights.

    Args:
        world: The world.
        bottom: Lower height [m].
        top: Upper height [m].

    Returns:
        Corners (N, 2), in order, of each outline [m].
    """
    return [
        outline
        for body in world.bodies
        if not body.is_kinematic
        for part in body.collisions
        for outline in slice_shape(part.shape, body.pose_in_world @ part.pose_in_body, bottom, top)
    ]


def _fill(solid: np.ndarray, outline: np.ndarray) -> None:
    """Set the cells that a convex outline (N, 2), in cells from the grid's corner, overlaps.

    By the separating axis theorem: a cell is not overlapped if an axis of the grid or the normal of an edge
    separates it from the outline.
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
