"""The exact occupancy grid of a world cut at a height: the map a perfect mapper would make."""

from typing import Iterator, List, Tuple

import numpy as np
from scipy.ndimage import label
from scipy.spatial import ConvexHull, QhullError

from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, Pose2
from sim_bridge.errors import WorldError
from sim_bridge.pose3 import transform_points
from sim_bridge.shapes import Box, Cylinder, Mesh, Plane, Shape, Sphere
from sim_bridge.world import World

# Corners of the polygons that stand for circles; with 72 the outline is true to 0.1 % of the radius.
CIRCLE_CORNERS = 72


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
    outlines = [outline for body in world.bodies for part in body.collisions
                for outline in _cut(part.shape, body.pose_in_world @ part.pose_in_body, bottom, top)]  # fmt: skip
    if not outlines:
        raise WorldError(f"world '{world.name}': nothing is solid at a height of {height:g} m")
    corners = np.vstack(outlines)
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
    if not grid.contains([[row, col]])[0] or solid[row, col]:
        raise WorldError(f"world '{world.name}': ({inside[0]:g}, {inside[1]:g}) is not free space")
    regions, _ = label(~solid)
    cells[regions == regions[row, col]] = FREE
    cells[solid] = OCCUPIED
    return grid


def _cut(shape: Shape, pose: np.ndarray, bottom: float, top: float) -> Iterator[np.ndarray]:
    """Outlines (N, 2), convex, of what of a placed shape lies between two heights, seen from above."""
    if isinstance(shape, Plane):
        return
    if isinstance(shape, Sphere):
        yield from _cut_sphere(shape.radius, pose[:3, 3], bottom, top)
    elif isinstance(shape, Mesh):
        vertices = transform_points(pose, shape.vertices)
        triangles = vertices[shape.triangles]
        crosses = (triangles[:, :, 2].min(axis=1) <= top) & (triangles[:, :, 2].max(axis=1) >= bottom)
        for triangle in triangles[crosses]:
            yield _between(triangle, _pairs(3), bottom, top)
    else:
        corners, edges = _prism(shape)
        outline = _between(transform_points(pose, corners), edges, bottom, top)
        if len(outline):
            yield _hull(outline)
