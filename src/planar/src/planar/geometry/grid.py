"""Occupancy grids."""

from dataclasses import dataclass, field
from typing import Iterable

import numpy as np

from planar.errors import OutOfRangeError, PlanarError
from planar.geometry.limits import MAX_RESOLUTION, MIN_RESOLUTION
from planar.geometry.pose import Pose2

FREE = 0
OCCUPIED = 100
UNKNOWN = -1


@dataclass(frozen=True, eq=False)
class OccupancyGrid:
    """Occupancy grid with the semantics of nav_msgs/OccupancyGrid.

    Attributes:
        cells: Occupancy, int8 (rows, cols): 0 free to 100 occupied, -1 unknown; row 0 has the lowest y.
        resolution: Cell size [m].
        origin: Pose in the map of the lower left corner of cell (0, 0).

    Raises:
        PlanarError: If the shape, resolution or origin is invalid.
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
            raise OutOfRangeError(f"invalid grid: cells of {self.resolution:g} m at {self.origin}")

    @property
    def rows(self) -> int:
        return self.cells.shape[0]

    @property
    def cols(self) -> int:
        return self.cells.shape[1]

    @property
    def in_bands(self) -> "BandedGrid":
        """The grid as a BandedGrid with one band."""
        return BandedGrid(self.rows, self.cols, self.resolution, self.origin, [self.cells])

    def cells_of(self, points_xy) -> np.ndarray:
        """Convert map points to cells.

        Args:
            points_xy: Points in the map [m], (N, 2).

        Returns:
            Cells as (row, col), int64 (N, 2); they may be outside the grid.
        """
        local_xy = self.origin.inverse().transform_points(np.atleast_2d(np.asarray(points_xy, dtype=float)))
        return np.floor(local_xy[:, ::-1] / self.resolution).astype(np.int64)

    def points_of(self, row_col: np.ndarray) -> np.ndarray:
        """Return the centres of cells in the map [m], (N, 2), from (row, col) indices (N, 2)."""
        local_xy = (np.atleast_2d(row_col)[:, ::-1] + 0.5) * self.resolution
        return self.origin.transform_points(local_xy)

    def contains(self, row_col: np.ndarray) -> np.ndarray:
        """Return which cells (N, 2) are in the grid, bool (N,)."""
        row, col = np.atleast_2d(row_col).T
        return (row >= 0) & (row < self.rows) & (col >= 0) & (col < self.cols)

    def value_at(self, x: float, y: float) -> int:
        """Return the value of the cell at a map point; UNKNOWN outside the grid."""
        cell = self.cells_of(np.array([[x, y]]))
        return int(self.cells[tuple(cell[0])]) if self.contains(cell)[0] else UNKNOWN


@dataclass(frozen=True, eq=False)
class BandedGrid:
    """Occupancy grid too large for memory, available once as bands of rows.

    Attributes:
        rows: Number of rows of the whole grid.
        cols: Number of columns of the whole grid.
        resolution: Cell size [m].
        origin: Pose in the map of the lower left corner of cell (0, 0).
        bands: Cells int8 (some rows, cols), top band first; row 0 of each band has its lowest y.
    """

    rows: int
    cols: int
    resolution: float
    origin: Pose2
    bands: Iterable[np.ndarray]

    def assemble(self) -> OccupancyGrid:
        """Return the whole grid."""
        cells, end = np.empty((self.rows, self.cols), dtype=np.int8), self.rows
        for band in self.bands:
            cells[end - len(band) : end] = band
            end -= len(band)
        return OccupancyGrid(cells, self.resolution, self.origin)


def grid_from_picture(
    picture: str, resolution: float = 1.0, origin: Pose2 = Pose2(), scale: int = 1
) -> OccupancyGrid:
    """Make a grid from text, top row first.

    Args:
        picture: ``#`` occupied, ``.`` or space free, ``?`` unknown.
        resolution: Cell size [m].
        origin: Pose in the map of the lower left corner.
        scale: Width and height of a character in cells.
    """
    lines = picture.strip("\n").splitlines()
    width = max(len(line) for line in lines)
    meaning = {"#": OCCUPIED, ".": FREE, " ": FREE, "?": UNKNOWN}
    cells = [[meaning[char] for char in line.ljust(width)] for line in reversed(lines)]
    return OccupancyGrid(np.kron(cells, np.ones((scale, scale))).astype(np.int8), resolution, origin)
