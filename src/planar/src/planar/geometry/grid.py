"""Occupancy grids: what is known of free and occupied space."""

from dataclasses import dataclass, field
from typing import Iterable

import numpy as np

from planar.errors import PlanarError
from planar.geometry.limits import MAX_RESOLUTION, MIN_RESOLUTION, OutOfRangeError
from planar.geometry.pose import Pose2

FREE = 0
OCCUPIED = 100
UNKNOWN = -1


@dataclass(frozen=True, eq=False)
class OccupancyGrid:
    """A grid of cells with the meaning of nav_msgs/OccupancyGrid.

    ``cells``: int8 (rows, cols), 0 free to 100 occupied, -1 unknown; row 0 is the lowest y.
    ``resolution``: metres per cell. ``origin``: pose in the map of the lower left corner of cell (0, 0).
    """

    cells: np.ndarray
    resolution: float
    origin: Pose2 = field(default_factory=Pose2)

    def __post_init__(self):
        if self.cells.ndim != 2 or self.cells.size == 0:
            raise PlanarError(f"a grid needs rows and columns, got shape {self.cells.shape}")
        if not self.resolution > 0.0:
            raise PlanarError(f"a grid needs a positive resolution, got {self.resolution}")
        if not (MIN_RESOLUTION <= self.resolution <= MAX_RESOLUTION and self.origin.is_in_range()):
            raise OutOfRangeError(f"a grid of {self.resolution:g} m a cell at {self.origin} means nothing")

    @property
    def rows(self) -> int:
        return self.cells.shape[0]

    @property
    def cols(self) -> int:
        return self.cells.shape[1]

    @property
    def in_bands(self) -> "BandedGrid":
        """The same, in one band."""
        return BandedGrid(self.rows, self.cols, self.resolution, self.origin, [self.cells])

    def cells_of(self, points_xy) -> np.ndarray:
        """Cells (N, 2) int64 as (row, col) in which map points (N, 2) lie; they may be outside the grid."""
        local_xy = self.origin.inverse().transform_points(np.atleast_2d(np.asarray(points_xy, dtype=float)))
        return np.floor(local_xy[:, ::-1] / self.resolution).astype(np.int64)

    def points_of(self, row_col: np.ndarray) -> np.ndarray:
        """Centres (N, 2) in the map of cells (N, 2) given as (row, col)."""
        local_xy = (np.atleast_2d(row_col)[:, ::-1] + 0.5) * self.resolution
        return self.origin.transform_points(local_xy)

    def contains(self, row_col: np.ndarray) -> np.ndarray:
        """Which of the cells (N, 2) lie in the grid: bool (N,)."""
        row, col = np.atleast_2d(row_col).T
        return (row >= 0) & (row < self.rows) & (col >= 0) & (col < self.cols)

    def value_at(self, x: float, y: float) -> int:
        """Value of the cell at a map point; unknown outside the grid."""
        cell = self.cells_of(np.array([[x, y]]))
        return int(self.cells[tuple(cell[0])]) if self.contains(cell)[0] else UNKNOWN


@dataclass(frozen=True, eq=False)
class BandedGrid:
    """An OccupancyGrid that is larger than memory should be, had in bands of its rows, once.

    ``bands``: cells int8 (some rows, cols), the top band first, in each of which row 0 has the lowest y.
    ``rows``, ``cols``, ``resolution``, ``origin``: of the whole grid.
    """

    rows: int
    cols: int
    resolution: float
    origin: Pose2
    bands: Iterable[np.ndarray]

    def assemble(self) -> OccupancyGrid:
        """The whole grid."""
        cells, end = np.empty((self.rows, self.cols), dtype=np.int8), self.rows
        for band in self.bands:
            cells[end - len(band) : end] = band
            end -= len(band)
        return OccupancyGrid(cells, self.resolution, self.origin)


def grid_from_picture(picture: str, resolution: float = 1.0, origin: Pose2 = Pose2()) -> OccupancyGrid:
    """A grid drawn as text, top row first: ``#`` occupied, ``.`` or space free, ``?`` unknown."""
    lines = picture.strip("\n").splitlines()
    width = max(len(line) for line in lines)
    meaning = {"#": OCCUPIED, ".": FREE, " ": FREE, "?": UNKNOWN}
    cells = [[meaning[char] for char in line.ljust(width)] for line in reversed(lines)]
    return OccupancyGrid(np.array(cells, dtype=np.int8), resolution, origin)
