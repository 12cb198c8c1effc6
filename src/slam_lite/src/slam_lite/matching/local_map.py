"""A local map: the surface points of some scans, indexed by a grid of nearest points, and a coarser one.

Two grids as in W. Hess et al., "Real-time loop closure in 2D LIDAR SLAM", ICRA 2016, and its successor in
space: a fine one around the robot, and one that reaches as far as lasers do outdoors.
"""

import math
from dataclasses import dataclass
from typing import Optional, Tuple

import numba
import numpy as np

from planar import Pose2
from slam_lite.surface import Surface, filled

# How far from a surface a point may lie and still be drawn to it, cells.
_REACH_CELLS = 6
# Standard deviation of the likelihood of a point given its distance from the surface, cells.
_SIGMA_CELLS = 2.0
# A point nearer than this to one that the map has adds nothing, cells.
_SAME = 0.5
# Cells along the border that stay empty, so that a search may look past it without missing anything.
BORDER_CELLS = 16
# What lies farther off than this, metres, is soon out of the fine grid; which share of it is too much.
_NEAR, _FAR_SHARE = 15.0, 0.2
# The coarser grid of maps that reach far: size of a cell and reach, metres.
_WIDE_RESOLUTION, _WIDE_REACH = 0.2, 85.0

# Two normals whose cosine is less than this belong to the two sides of a wall.
OPPOSED = -0.5

# A local map's four arrays, its resolution, and how far its corner lies below the finest one's, (2,).
Layer = Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, float, np.ndarray]


class LocalMap:
    """Surface points around a centre; each grid cell knows the nearest one and how likely a hit there is.

    The grid is square, ``2 * reach`` metres wide, in the frame in which the poses given to ``add`` are.
    ``beyond``: a coarser one of the same points, and of those that lie farther off.
    ``nearest``: indices, -1 for none near, into ``points_xy`` and ``normals_xy``, float32 (N, 2), metres from
    the grid's corner, of which the first ``count`` count. ``likelihood``: 0 to 255.
    """

    def __init__(self, resolution: float = 0.05, reach: float = 25.0, beyond: "Optional[LocalMap]" = None):
        cells = math.ceil(2.0 * reach / resolution) + 2 * BORDER_CELLS
        self.resolution = resolution
        self.beyond = beyond
        self.corner = np.zeros(2)
        self.nearest = np.full((cells, cells), -1, dtype=np.int32)
        self.likelihood = np.zeros((cells, cells), dtype=np.uint8)
        self.points_xy = np.empty((0, 2), dtype=np.float32)
        self.normals_xy = np.empty((0, 2), dtype=np.float32)
        self.count = 0

    def clear(self, center: Pose2) -> None:
        """Forgets all points and moves the grid so that ``center`` lies in its middle."""
        half = 0.5 * len(self.nearest) * self.resolution
        self.corner = np.array([center.x - half, center.y - half])
        self.nearest.fill(-1)
        self.likelihood.fill(0)
        self.count = 0
        if self.beyond is not None:
            self.beyond.clear(center)

    def add(self, surface: Surface, base_pose: Pose2) -> None:
        """Adds the surface seen from ``base_pose``; points beyond the grid are left out."""
        needed = self.count + len(surface)
        if needed > len(self.points_xy):
            self.points_xy = _grown(self.points_xy, needed)
            self.normals_xy = _grown(self.normals_xy, needed)
        self.count = _add(
            self.nearest,
            self.likelihood,
            self.points_xy,
            self.normals_xy,
            self.count,
            surface.points_xy,
            surface.normals_xy,
            base_pose.x - self.corner[0],
            base_pose.y - self.corner[1],
            base_pose.yaw,
            self.resolution,
            _LIKELIHOOD,
        )
        if self.beyond is not None:
            self.beyond.add(filled(surface, 1.5 * self.beyond.resolution), base_pose)

    @property
    def is_empty(self) -> bool:
        """Whether it has no points, near or far."""
        return self.count == 0 and (self.beyond is None or self.beyond.is_empty)

    def fit_for(self, surface: Surface) -> "LocalMap":
        """The one to search a surface in: itself, or the one beyond if too much of it lies there."""
        far = np.hypot(surface.points_xy[:, 0], surface.points_xy[:, 1]) > _NEAR
        return self.beyond if self.beyond is not None and np.mean(far) > _FAR_SHARE else self

    @property
    def layers(self) -> Tuple[Layer, Layer]:
        """The grid itself and the one beyond, if there is one, for kernels."""
        return _layer(self, self), _layer(self.beyond or _NOTHING, self)

    def to_grid(self, pose: Pose2) -> np.ndarray:
        """A pose as ``[x, y, yaw]``, metres from the grid's corner."""
        return np.array([pose.x - self.corner[0], pose.y - self.corner[1], pose.yaw])

    def from_grid(self, pose: np.ndarray) -> Pose2:
        """The inverse of ``to_grid``."""
        return Pose2(float(pose[0] + self.corner[0]), float(pose[1] + self.corner[1]), float(pose[2]))


_NOTHING = LocalMap(1.0, 0.0)


def _layer(grid: LocalMap, seen_from: LocalMap) -> Layer:
    arrays = (grid.nearest, grid.likelihood, grid.points_xy, grid.normals_xy)
    nearest, likelihood, points_xy, normals_xy = (_read_only(array) for array in arrays)
    return nearest, likelihood, points_xy, normals_xy, grid.resolution, seen_from.corner - grid.corner


def _read_only(array: np.ndarray) -> np.ndarray:
    """The same, so that maps that may be written and others are one type for kernels."""
    view = array.view()
    view.flags.writeable = False
    return view


@dataclass(frozen=True, eq=False)
class Match:
    """Where a surface fits: ``base_pose`` in the local map's frame.

    ``information``: (3, 3), 1 / (m, m, rad)^2, of base_pose's x, y, yaw along the map's axes.
    ``response``: share of the surface's points, 0 to 1, that lie on the map's surfaces.
    """

    base_pose: Pose2
    information: np.ndarray
    response: float


def wide_map() -> LocalMap:
    """An empty local map that reaches as far as lasers do outdoors."""
    return LocalMap(beyond=LocalMap(_WIDE_RESOLUTION, _WIDE_REACH))


@numba.njit(cache=True, nogil=True)
def cell_of(layers, x, y):
    """The number of the layer that knows of a point at (x, y) metres, and the point's row and column there.

    The layer is -1 for a point that lies beyond both.
    """
    for number in range(2):
        nearest, _, _, _, resolution, shift = layers[number]
        col, row = int(math.floor((x + shift[0]) / resolution)), int(math.floor((y + shift[1]) / resolution))
        border, side = (BORDER_CELLS + _REACH_CELLS), len(nearest)
        if border <= col < side - border and border <= row < side - border:
            return number, row, col
    return -1, 0, 0


@numba.njit(cache=True, nogil=True)
def are_far(layers, points, pose):
    """Which points (N,) only the coarser layer may know of."""
    is_far = np.empty(len(points), dtype=np.bool_)
    c, s = math.cos(pose[2]), math.sin(pose[2])
    for p in range(len(points)):
        x, y = pose[0] + c * points[p, 0] - s * points[p, 1], pose[1] + s * points[p, 0] + c * points[p, 1]
        is_far[p] = cell_of(layers, x, y)[0] != 0
    return is_far


@numba.njit(cache=True, nogil=True, inline="always")
def turned_cosine(normal, map_normal, c, s):
    """Of the angle between a normal, turned by the angle whose cosine and sine are c and s, and another."""
    nx, ny = map_normal[0], map_normal[1]
    return c * (normal[0] * nx + normal[1] * ny) + s * (normal[0] * ny - normal[1] * nx)


def _likelihood_kernel() -> np.ndarray:
    squared = np.arange((_REACH_CELLS + 1) ** 2 * 2 + 1)
    return np.rint(255.0 * np.exp(-0.5 * squared / _SIGMA_CELLS**2)).astype(np.uint8)


_LIKELIHOOD = _likelihood_kernel()


def _grown(array: np.ndarray, needed: int) -> np.ndarray:
    grown = np.empty((max(needed, 2 * len(array)), 2), dtype=np.float32)
    grown[: len(array)] = array
    return grown


@numba.njit(cache=True, nogil=True)
def _add(nearest, likelihood, map_points, map_normals, count, points, normals, x, y, yaw, resolution, kernel):
    c, s = math.cos(yaw), math.sin(yaw)
    side = len(nearest)
    reach, border = _REACH_CELLS, BORDER_CELLS + _REACH_CELLS
    for i in range(len(points)):
        px, py = x + c * points[i, 0] - s * points[i, 1], y + s * points[i, 0] + c * points[i, 1]
        col, row = int(math.floor(px / resolution)), int(math.floor(py / resolution))
        if not (border <= col < side - border and border <= row < side - border):
            continue
        known = nearest[row, col]
        if (
            known >= 0
            and math.hypot(px - map_points[known, 0], py - map_points[known, 1]) < _SAME * resolution
        ):
            continue
        map_points[count, 0], map_points[count, 1] = px, py
        map_normals[count, 0] = c * normals[i, 0] - s * normals[i, 1]
        map_normals[count, 1] = s * normals[i, 0] + c * normals[i, 1]
        u, v = px / resolution, py / resolution
        for r in range(row - reach, row + reach + 1):
            for q in range(col - reach, col + reach + 1):
                squared = (q + 0.5 - u) ** 2 + (r + 0.5 - v) ** 2
                old = nearest[r, q]
                if old >= 0:
                    du, dv = map_points[old, 0] / resolution, map_points[old, 1] / resolution
                    if squared >= (q + 0.5 - du) ** 2 + (r + 0.5 - dv) ** 2:
                        continue
                nearest[r, q] = count
                likelihood[r, q] = kernel[int(squared)]
        count += 1
    return count
