"""Horizontal slices through solid shapes."""

import math
from typing import Iterator, Union

import numpy as np

from sim_bridge.geometry.pose3 import transform_points
from sim_bridge.geometry.shapes import Box, Cylinder, Mesh, Plane, Shape, Sphere

# Largest distance of the polygon of a circle from the circle [m].
CIRCLE_DEVIATION = 5e-4
# Cosine of the tilt up to which a slice of a box or cylinder is its whole outline.
UPRIGHT = 1.0 - 1e-12


def slice_shape(shape: Shape, pose: np.ndarray, bottom: float, top: float) -> Iterator[np.ndarray]:
    """Yield convex outlines, seen from above, of the part of a shape between two heights.

    Args:
        shape: The shape; a plane, which is a floor, has no outline.
        pose: Pose (4, 4) of the shape.
        bottom: Lower height [m].
        top: Upper height [m].

    Yields:
        Corners (N, 2), in order, of each outline.
    """
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
        x, y, z = pose[:3, 3]
        off_centre = max(bottom - z, z - top, 0.0)
        if off_centre < shape.radius:
            yield _circle(math.sqrt(shape.radius**2 - off_centre**2)) + (x, y)
        return
    points = transform_points(pose, _corners(shape))
    if points[:, 2].max() < bottom or points[:, 2].min() > top:
        return
    is_upright = abs(pose[2, 2]) > UPRIGHT
    yield points[: len(points) // 2, :2] if is_upright else _outline(_between(points, bottom, top))


def _corners(shape: Union[Box, Cylinder]) -> np.ndarray:
    """Return the corners (N, 3) of a box, or of a prism for a cylinder: those below, in order, then above."""
    if isinstance(shape, Cylinder):
        base, height = _circle(shape.radius), shape.length
    else:
        length, width, height = shape.size
        base = np.array(((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))) * (length, width)
    half = np.full((len(base), 1), 0.5 * height)
    return np.vstack((np.hstack((base, -half)), np.hstack((base, half))))


def _circle(radius: float) -> np.ndarray:
    """Return the corners (N, 2), in order, of a polygon in a circle around the origin."""
    bend = min(CIRCLE_DEVIATION / radius, 0.3)
    angles = np.linspace(0.0, 2.0 * math.pi, math.ceil(math.pi / math.acos(1.0 - bend)), endpoint=False)
    return radius * np.column_stack((np.cos(angles), np.sin(angles)))


def _between(points_xyz: np.ndarray, bottom: float, top: float) -> np.ndarray:
    """Return points (N, 3) whose convex hull is that of ``points_xyz``, clipped to two heights.

    Each pair of points on both sides of a plane adds its intersection: a superset of the hull's edges.
    """
    for level, side in ((bottom, 1.0), (top, -1.0)):
        above = side * (points_xyz[:, 2] - level)
        inside, outside = above >= 0.0, above < 0.0
        fraction = above[inside, None] / (above[inside, None] - above[None, outside])
        crossings = points_xyz[inside, None] + fraction[..., None] * (
            points_xyz[None, outside] - points_xyz[inside, None]
        )
        crossings[..., 2] = level
        points_xyz = np.vstack((points_xyz[inside], crossings.reshape(-1, 3)))
    return points_xyz


def _outline(points_xyz: np.ndarray) -> np.ndarray:
    """Return the corners (N, 2), in order, of the planar convex hull; all points if collinear."""
    from scipy.spatial import ConvexHull, QhullError  # late: few worlds have meshes

    points_xy = points_xyz[:, :2]
    try:
        return points_xy[ConvexHull(points_xy).vertices]
    except QhullError:
        return points_xy
