"""The local map: the points of some scans, indexed by a fine and a coarse grid of nearest points.

Two grids as in W. Hess et al., "Real-time loop closure in 2D LIDAR SLAM", ICRA 2016, and its 3D version: a
fine one around the robot, and a coarse one with the range of lasers outdoors.
"""

import math
import warnings
from dataclasses import dataclass
from typing import Optional, Tuple

import numba
import numpy as np

from planar import Pose2
from planar.deprecation import renamed_method
from slam_lite.point_cloud import PointCloud, interpolated

# Largest distance of a point from a map point that it is matched to, cells.
_REACH_CELLS = 6
# Standard deviation of the likelihood of a point by its distance from the nearest map point, cells.
_SIGMA_CELLS = 2.0
# A point nearer than this to one of the map is not added, cells.
_SAME = 0.5
# Parts of a cell, along each axis, for which the largest likelihoods around it are stored; and more than the
# rounding errors of a squared distance, cells^2.
_CELL_PARTS, _ROUNDING = 16, 1e-6
# Cells along the border that stay empty, so that a search window may extend past it.
BORDER_CELLS = 16
# Points farther away than this [m] soon leave the fine grid; the share of them from which on the coarse one
# is searched.
_NEAR, _FAR_SHARE = 15.0, 0.2
# The coarse grid: cell size and reach [m].
_COARSE_RESOLUTION, _COARSE_REACH = 0.2, 85.0

# Two normals whose cosine is less than this belong to the two sides of a wall.
OPPOSED = -0.5

# The four arrays of a local map, and with its resolution and the offset (2,) of its corner from the finest
# one's.
LayerArrays = Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
Layer = Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, float, np.ndarray]


class LocalMap:
    """Points around a centre; each grid cell stores the nearest point and the likelihood of a hit.

    The grid is square, ``2 * reach`` metres wide, in the frame of the poses given to ``add``.

    Attributes:
        resolution: Cell size [m].
        coarse_map: Coarser map of the same points and of those farther away; None if there is none.
        corner: (2,), lower left corner of the grid [m].
        nearest: int32 (rows, cols), index of the nearest point of each cell, -1 if none is near.
        likelihood: uint8 (rows, cols), likelihood of a hit in each cell, 0 to 255.
        points_xy: float32 (M, 2), metres from the corner; the first ``count`` are used.
        normals_xy: float32 (M, 2), surface normals of the points, or (0, 0).
        count: Number of points.
    """

    def __init__(
        self, resolution: float = 0.05, reach: float = 25.0, coarse_map: "Optional[LocalMap]" = None
    ):
        """Create an empty map.

        Args:
            resolution: Cell size [m].
            reach: Half the width of the grid [m].
            coarse_map: Map that gets the same points, with larger cells and a larger reach.
        """
        cells = math.ceil(2.0 * reach / resolution) + 2 * BORDER_CELLS
        self.resolution = resolution
        self.coarse_map = coarse_map
        self.corner = np.zeros(2)
        self.nearest = np.full((cells, cells), -1, dtype=np.int32)
        self.likelihood = np.zeros((cells, cells), dtype=np.uint8)
        self.points_xy = np.empty((0, 2), dtype=np.float32)
        self.normals_xy = np.empty((0, 2), dtype=np.float32)
        self.count = 0

    def clear(self, center: Pose2) -> None:
        """Remove all points and centre the grid at a pose.

        Args:
            center: Pose whose position becomes the middle of the grid.
        """
        half = 0.5 * len(self.nearest) * self.resolution
        self.corner = np.array([center.x - half, center.y - half])
        self.nearest.fill(-1)
        self.likelihood.fill(0)
        self.count = 0
        if self.coarse_map is not None:
            self.coarse_map.clear(center)

    def add(self, cloud: PointCloud, base_pose: Pose2, is_coarse_searched: bool = True) -> None:
        """Add a scan; points outside of the grid are ignored.

        Args:
            cloud: Points of the scan, in the base frame.
            base_pose: Pose of the base in the frame of the map.
            is_coarse_searched: Whether the coarse map is searched alone; otherwise it gets only the points
                outside of this one, which is faster.
        """
        self._add(cloud, base_pose, 0.0)
        if self.coarse_map is not None:
            inner = 0.0 if is_coarse_searched else self._reach - 2.0 * _REACH_CELLS * _COARSE_RESOLUTION
            self.coarse_map._add(interpolated(cloud, 1.5 * self.coarse_map.resolution), base_pose, inner)

    @property
    def _reach(self) -> float:
        """Distance from the middle within which points are in this grid [m]."""
        return (0.5 * len(self.nearest) - BORDER_CELLS - _REACH_CELLS) * self.resolution

    def _add(self, cloud: PointCloud, base_pose: Pose2, inner: float) -> None:
        """Add the points that are farther than ``inner`` [m] from the middle, in x or in y."""
        needed = self.count + len(cloud)
        if needed > len(self.points_xy):
            self.points_xy = _grown(self.points_xy, needed)
            self.normals_xy = _grown(self.normals_xy, needed)
        self.count = _add(
            self.nearest,
            self.likelihood,
            self.points_xy,
            self.normals_xy,
            self.count,
            cloud.points_xy,
            cloud.normals_xy,
            base_pose.x - self.corner[0],
            base_pose.y - self.corner[1],
            base_pose.yaw,
            self.resolution,
            _LIKELIHOOD,
            _LARGEST_LIKELIHOOD,
            inner / self.resolution,
        )

    @property
    def is_empty(self) -> bool:
        """Whether neither this map nor the coarse one has points."""
        return self.count == 0 and (self.coarse_map is None or self.coarse_map.is_empty)

    def layer_for(self, cloud: PointCloud) -> "LocalMap":
        """Return the map to search a cloud in: this one, or the coarse one if too many points are far away.

        Args:
            cloud: Points to search, in the base frame.
        """
        far = np.hypot(cloud.points_xy[:, 0], cloud.points_xy[:, 1]) > _NEAR
        return self.coarse_map if self.coarse_map is not None and np.mean(far) > _FAR_SHARE else self

    # Deprecated names, for matchers written for an earlier version.
    fit_for = renamed_method("fit_for", "layer_for")

    @property
    def beyond(self) -> "Optional[LocalMap]":
        """Deprecated name of ``coarse_map``."""
        warnings.warn("LocalMap.beyond is deprecated; use coarse_map", DeprecationWarning, stacklevel=2)
        return self.coarse_map

    @property
    def layers(self) -> Tuple[Layer, Layer]:
        """This map and the coarse one, as tuples for numba kernels; without a coarse map, an empty one."""
        return _layer(self, self), _layer(self.coarse_map or _EMPTY, self)

    @property
    def packed_layers(self) -> Tuple[LayerArrays, LayerArrays, np.ndarray]:
        """``layers`` as three arguments for a kernel, which ``unpacked`` turns into layers.

        numba 0.58 does not recognize the type of a tuple of more than four arrays from call to call, and
        finds it again each time, which takes longer than a match.
        """
        coarse = self.coarse_map or _EMPTY
        geometry = np.array([_geometry(self, self), _geometry(coarse, self)])
        return _layer_arrays(self), _layer_arrays(coarse), geometry

    def to_grid(self, pose: Pose2) -> np.ndarray:
        """Convert a pose to ``[x, y, yaw]``, in metres from the corner of the grid."""
        return np.array([pose.x - self.corner[0], pose.y - self.corner[1], pose.yaw])

    def from_grid(self, pose: np.ndarray) -> Pose2:
        """Convert ``[x, y, yaw]``, in metres from the corner of the grid, to a pose."""
        return Pose2(float(pose[0] + self.corner[0]), float(pose[1] + self.corner[1]), float(pose[2]))


_EMPTY = LocalMap(1.0, 0.0)


def _layer(grid: LocalMap, finest: LocalMap) -> Layer:
    return (*_layer_arrays(grid), grid.resolution, finest.corner - grid.corner)


def _layer_arrays(grid: LocalMap) -> LayerArrays:
    arrays = (grid.nearest, grid.likelihood, grid.points_xy, grid.normals_xy)
    nearest, likelihood, points_xy, normals_xy = (_read_only(array) for array in arrays)
    return nearest, likelihood, points_xy, normals_xy


def _geometry(grid: LocalMap, finest: LocalMap) -> Tuple[float, float, float]:
    """Resolution, and offset of the corner from the finest map's."""
    x, y = finest.corner - grid.corner
    return grid.resolution, x, y


def _read_only(array: np.ndarray) -> np.ndarray:
    """A read-only view, so that writable and read-only maps are one type for kernels."""
    view = array.view()
    view.flags.writeable = False
    return view


@dataclass(frozen=True, eq=False)
class Match:
    """Result of matching a scan to a local map.

    Attributes:
        base_pose: Pose of the base in the frame of the local map.
        information: (3, 3), of x, y and yaw of ``base_pose`` along the axes of the local map, 1 / (m, m,
            rad)^2.
        response: Fraction of the scan's points, 0 to 1, that lie on the map's surfaces.
    """

    base_pose: Pose2
    information: np.ndarray
    response: float


def long_range_map() -> LocalMap:
    """Create an empty local map with a coarse map that has the range of lasers outdoors."""
    return LocalMap(coarse_map=LocalMap(_COARSE_RESOLUTION, _COARSE_REACH))


@numba.njit(cache=True, nogil=True)
def unpacked(fine, coarse, geometry):
    """Return the layers that ``LocalMap.packed_layers`` contains, inside a kernel.

    Args:
        fine: Arrays of the finest layer.
        coarse: Arrays of the coarse layer.
        geometry: (2, 3), resolution and offset of each layer.
    """
    return fine + (geometry[0, 0], geometry[0, 1:]), coarse + (geometry[1, 0], geometry[1, 1:])


@numba.njit(cache=True, nogil=True)
def cell_of(layers, x, y):
    """Find the cell of a point in the finest layer that contains it.

    Args:
        layers: Layers of a local map (``LocalMap.layers``).
        x: Position from the corner of the finest grid [m].
        y: Position from the corner of the finest grid [m].

    Returns:
        Number of the layer (-1 if the point is outside of both), row and column.
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
    """Find the points outside of the finest layer.

    Args:
        layers: Layers of a local map (``LocalMap.layers``).
        points: (N, 2), in the base frame [m].
        pose: (3,), pose of the base from the corner of the finest grid (``LocalMap.to_grid``).

    Returns:
        (N,) booleans.
    """
    is_far = np.empty(len(points), dtype=np.bool_)
    c, s = math.cos(pose[2]), math.sin(pose[2])
    for p in range(len(points)):
        x, y = pose[0] + c * points[p, 0] - s * points[p, 1], pose[1] + s * points[p, 0] + c * points[p, 1]
        is_far[p] = cell_of(layers, x, y)[0] != 0
    return is_far


@numba.njit(cache=True, nogil=True, inline="always")
def turned_cosine(normal, map_normal, c, s):
    """Compute the cosine between a rotated normal and a normal of the map.

    Args:
        normal: (2,), unit normal in the base frame.
        map_normal: (2,), unit normal in the frame of the map.
        c: Cosine of the heading of the base.
        s: Sine of the heading of the base.
    """
    nx, ny = map_normal[0], map_normal[1]
    return c * (normal[0] * nx + normal[1] * ny) + s * (normal[0] * ny - normal[1] * nx)


def _likelihood_kernel() -> np.ndarray:
    squared = np.arange((_REACH_CELLS + 1) ** 2 * 2 + 1)
    return np.rint(255.0 * np.exp(-0.5 * squared / _SIGMA_CELLS**2)).astype(np.uint8)


_LIKELIHOOD = _likelihood_kernel()


def _largest_likelihood() -> np.ndarray:
    """Largest likelihood that a point gives the cells around it, wherever it lies in a part of its cell.

    Returns:
        uint8 (parts, parts, side, side), by the point's part in y and in x, and by the row and column of the
        other cell.
    """
    parts = np.arange(_CELL_PARTS) / _CELL_PARTS
    centers = np.arange(-_REACH_CELLS, _REACH_CELLS + 1) + 0.5
    apart = np.maximum(parts[:, None] - centers, centers - parts[:, None] - 1.0 / _CELL_PARTS)
    nearest = np.maximum(apart, 0.0) ** 2
    squared = nearest[:, None, :, None] + nearest[None, :, None, :]
    return _LIKELIHOOD[np.maximum(squared - _ROUNDING, 0.0).astype(np.int64)]


_LARGEST_LIKELIHOOD = _largest_likelihood()


def _grown(array: np.ndarray, needed: int) -> np.ndarray:
    grown = np.empty((max(needed, 2 * len(array)), 2), dtype=np.float32)
    grown[: len(array)] = array
    return grown


@numba.njit(cache=True, nogil=True)
def _add(
    nearest,
    likelihood,
    map_points,
    map_normals,
    count,
    points,
    normals,
    x,
    y,
    yaw,
    resolution,
    kernel,
    largest,
    inner,
):
    c, s = math.cos(yaw), math.sin(yaw)
    side, border = len(nearest), BORDER_CELLS + _REACH_CELLS
    for i in range(len(points)):
        px, py = x + c * points[i, 0] - s * points[i, 1], y + s * points[i, 0] + c * points[i, 1]
        u, v = px / resolution, py / resolution
        col, row = int(math.floor(u)), int(math.floor(v))
        if not (border <= col < side - border and border <= row < side - border):
            continue
        if abs(col - 0.5 * side) < inner and abs(row - 0.5 * side) < inner:
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
        _update_cells(nearest, likelihood, map_points, count, u, v, resolution, kernel, largest)
        count += 1
    return count


@numba.njit(cache=True, nogil=True, inline="always")
def _update_cells(nearest, likelihood, map_points, number, u, v, resolution, kernel, largest):
    """Store a new point at (u, v), in cells, in the cells around it to which no other one is nearer."""
    parts, width = len(largest), largest.shape[2]
    col, row = int(math.floor(u)), int(math.floor(v))
    bounds = largest[int((v - row) * parts), int((u - col) * parts)]
    first = col - _REACH_CELLS
    for j in range(width):
        r = row - _REACH_CELLS + j
        bound, line, along_y = bounds[j], likelihood[r, first : first + width], (r + 0.5 - v) ** 2
        for k in range(width):
            if bound[k] < line[k]:
                continue  # without its distance: another point is nearer, wherever this one is
            squared = (first + k + 0.5 - u) ** 2 + along_y
            if kernel[int(squared)] < line[k]:
                continue  # the likelihood alone shows that another point is nearer
            old = nearest[r, first + k]
            if old >= 0:
                du, dv = map_points[old, 0] / resolution, map_points[old, 1] / resolution
                if squared >= (first + k + 0.5 - du) ** 2 + (r + 0.5 - dv) ** 2:
                    continue
            nearest[r, first + k] = number
            line[k] = kernel[int(squared)]
