"""The likelihood field of a map (Probabilistic Robotics, section 6.4)."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numba
import numpy as np

from planar import OCCUPIED, OccupancyGrid, Pose2
from planar.deprecation import deprecated_names
from planar.geometry.distance_field import distance_field


class MapToCells(NamedTuple):
    """Transform from map poses to columns, rows and headings of a field, for kernels.

    Attributes:
        col: Column of the map's origin.
        row: Row of the map's origin.
        yaw: Rotation [rad].
        cos: Cosine of ``yaw`` times ``scale``.
        sin: Sine of ``yaw`` times ``scale``.
        scale: Cells per metre.
    """

    col: float
    row: float
    yaw: float
    cos: float
    sin: float
    scale: float


@dataclass(frozen=True, eq=False)
class LikelihoodField:
    """exp(-d^2 / 2 sigma^2) for each cell at distance d from the nearest obstacle (table 6.3).

    Attributes:
        fit: float32 (rows + 2, cols + 2), 1 on obstacles; the border represents everything off the map.
        sigma: Standard deviation [m].
        resolution: Cell size [m].
        origin: Pose of the map's origin.
    """

    fit: np.ndarray
    sigma: float
    resolution: float
    origin: Pose2

    @cached_property
    def map_to_cells(self) -> MapToCells:
        map_in_grid, scale = self.origin.inverse(), 1.0 / self.resolution
        col, row, yaw = 1.0 + scale * map_in_grid.x, 1.0 + scale * map_in_grid.y, map_in_grid.yaw
        return MapToCells(col, row, yaw, scale * math.cos(yaw), scale * math.sin(yaw), scale)

    def pose_from_cells(self, col: float, row: float, yaw: float) -> Pose2:
        """Convert a pose in cells of ``fit`` to the map."""
        return self.origin @ Pose2((col - 1.0) * self.resolution, (row - 1.0) * self.resolution, yaw)

    def value_at_distance(self, distance: float) -> float:
        """Return the value at a distance from the nearest obstacle [m]."""
        return math.exp(-0.5 * (distance / self.sigma) ** 2)


def likelihood_field(grid: OccupancyGrid, sigma: float, max_distance: float) -> LikelihoodField:
    """Compute the field of a map's occupied cells; distances are truncated at ``max_distance`` [m]."""
    distances = distance_field(grid.cells == OCCUPIED, grid.resolution, max_distance)
    fit = np.full((grid.rows + 2, grid.cols + 2), math.exp(-0.5 * (max_distance / sigma) ** 2), np.float32)
    np.exp(-0.5 * (distances / np.float32(sigma)) ** 2, out=fit[1:-1, 1:-1])
    return LikelihoodField(fit, sigma, grid.resolution, grid.origin)


@numba.njit(cache=True, inline="always")
def pose_in_cells(x, y, yaw, map_to_cells):
    """Convert a map pose to column, row, and cosine and sine of its heading in cells per metre."""
    heading = yaw + map_to_cells.yaw
    return (
        map_to_cells.col + map_to_cells.cos * x - map_to_cells.sin * y,
        map_to_cells.row + map_to_cells.sin * x + map_to_cells.cos * y,
        map_to_cells.scale * math.cos(heading),
        map_to_cells.scale * math.sin(heading),
    )


@numba.njit(cache=True, inline="always")
def fit_at(fit, col, row):
    """Return the value at a position in cells, also off the map; without branches, to be vectorized."""
    i = np.int32(min(max(row, 0.0), fit.shape[0] - 1.0))
    j = np.int32(min(max(col, 0.0), fit.shape[1] - 1.0))
    return fit[i, j]


# The cache index of numba from an older version contains the name; without it the index is unreadable.
__getattr__ = deprecated_names(__name__, {"IntoCells": "MapToCells"})
