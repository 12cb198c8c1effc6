"""The exact occupancy grid of a world cut at a height: the map a perfect mapper would make."""

import math
from typing import Iterator, Tuple, Union

import numpy as np
from scipy.ndimage import label
from scipy.spatial import ConvexHull, QhullError

from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, Pose2
from sim_bridge.errors import WorldError
from sim_bridge.pose3 import transform_points
from sim_bridge.shapes import Box, Cylinder, Mesh, Plane, Shape, Sphere
from sim_bridge.world import World

# A solid that reaches less far than this, in cells, into a cell only touches it (1.5708 is not quite pi/2).
TOUCH = 0.02
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
    outlines = [
        outline
        for body in world.bodies
        for part in body.collisions
        for outline in _cut(part.shape, body.pose_in_world @ part.pose_in_body, bottom, top)
    ]
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
    regions, _ = label(~solid)
    cells[regions == regions[row, col]] = FREE
    cells[solid] = OCCUPIED
    return grid


def _cut(shape: Shape, pose: np.ndarray, bottom: float, top: float) -> Iterator[np.ndarray]:
    """Convex outlines (N, 2), seen from above, of what of a placed shape lies between two heights."""
    if isinstance(shape, Plane):
        return
    if isinstance(shape, Mesh):
        triangles = transform_points(pose, shape.vertices)[shape.triangles]
        heights = triangles[:, :, 2]
        crosses = (heights.min(axis=1) <= top) & (heights.max(axis=1) >= bottom)
        for triangle in triangles[crosses]:
            yield _outline(_between(triangle, bottom, top))
        return
    if isinstance(shape, Sphere):
        centre = pose[:3, 3]
        nearest = min(max(centre[2], bottom), top) - centre[2]
        points = centre + _circle(math.sqrt(max(shape.radius**2 - nearest**2, 0.0)), nearest)
    else:
        points = transform_points(pose, _corners(shape))
    points = _between(points, bottom, top)
    if len(points):
        yield _outline(points)


def _corners(shape: Union[Box, Cylinder]) -> np.ndarray:
    """Corners (N, 3) of a box, or of a prism for a cylinder."""
    if isinstance(shape, Cylinder):
        ends = (-shape.length / 2.0, shape.length / 2.0)
        return np.vstack([_circle(shape.radius, z) for z in ends])
    signs = np.array(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5])).reshape(3, -1).T
    return signs * shape.size


def _circle(radius: float, z: float) -> np.ndarray:
    angles = np.arange(CIRCLE_CORNERS) * (2.0 * math.pi / CIRCLE_CORNERS)
    return np.column_stack((radius * np.cos(angles), radius * np.sin(angles), np.full(CIRCLE_CORNERS, z)))


def _between(points_xyz: np.ndarray, bottom: float, top: float) -> np.ndarray:
    """Points (N, 3) whose convex hull is that of ``points_xyz`` cut off below ``bottom`` and above ``top``.

    Every pair of points on two sides of a cut adds where it crosses: a superset of the hull's edges.
    """
    for level, side in ((bottom, 1.0), (top, -1.0)):
        above = side * (points_xyz[:, 2] - level)
        kept, gone = above >= 0.0, above < 0.0
        share = above[kept, None] / (above[kept, None] - above[None, gone])
        crossings = points_xyz[kept, None] + share[..., None] * (
            points_xyz[None, gone] - points_xyz[kept, None]
        )
        points_xyz = np.vstack((points_xyz[kept], crossings.reshape(-1, 3)))
    return points_xyz


def _outline(points_xyz: np.ndarray) -> np.ndarray:
    """Corners (N, 2), in order, of the convex hull seen from above; all points if they lie on one line."""
    points_xy = points_xyz[:, :2]
    try:
        return points_xy[ConvexHull(points_xy).vertices]
    except QhullError:
        return points_xy


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
