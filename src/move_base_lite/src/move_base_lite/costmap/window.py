"""Cells of a costmap: their number, size and position in its frame."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple, Tuple

from planar.deprecation import deprecated_names


class CellBounds(NamedTuple):
    """A block of cells, empty if a maximum is not above its minimum.

    Attributes:
        row_min: First row.
        row_max: Row after the last one.
        col_min: First column.
        col_max: Column after the last one.
    """

    row_min: int
    row_max: int
    col_min: int
    col_max: int

    @property
    def slices(self) -> Tuple[slice, slice]:
        """Slices of rows and columns, to index arrays."""
        return slice(self.row_min, self.row_max), slice(self.col_min, self.col_max)


NO_CELLS = CellBounds(0, 0, 0, 0)


def union(a: CellBounds, b: CellBounds) -> CellBounds:
    """Compute the smallest block that contains two blocks."""
    if a.row_min >= a.row_max or a.col_min >= a.col_max:
        return b
    if b.row_min >= b.row_max or b.col_min >= b.col_max:
        return a
    return CellBounds(
        min(a.row_min, b.row_min),
        max(a.row_max, b.row_max),
        min(a.col_min, b.col_min),
        max(a.col_max, b.col_max),
    )


@dataclass(frozen=True)
class CostmapWindow:
    """An axis-aligned grid of cells in the costmap's frame.

    Attributes:
        rows: Number of cells along y.
        cols: Number of cells along x.
        resolution: Cell size [m].
        origin_x: Lower left corner of cell (0, 0) [m].
        origin_y: Lower left corner of cell (0, 0) [m].
    """

    rows: int
    cols: int
    resolution: float
    origin_x: float = 0.0
    origin_y: float = 0.0

    def cell_of(self, x: float, y: float) -> Tuple[int, int]:
        """Compute row and column of a point, which may be outside of the window.

        Args:
            x: Position in the costmap's frame [m].
            y: Position in the costmap's frame [m].
        """
        return (
            math.floor((y - self.origin_y) / self.resolution),
            math.floor((x - self.origin_x) / self.resolution),
        )

    def contains(self, x: float, y: float) -> bool:
        """Check whether a point lies in the window.

        Args:
            x: Position in the costmap's frame [m].
            y: Position in the costmap's frame [m].
        """
        row, col = self.cell_of(x, y)
        return 0 <= row < self.rows and 0 <= col < self.cols

    def has_same_size(self, other: "CostmapWindow") -> bool:
        """Check whether another window has the same number of cells of the same size."""
        return replace(self, origin_x=other.origin_x, origin_y=other.origin_y) == other

    def centred_on(self, x: float, y: float) -> "CostmapWindow":
        """Move the window by whole cells so that it is centred on a point.

        Args:
            x: Position in the costmap's frame [m].
            y: Position in the costmap's frame [m].
        """
        row, col = self.cell_of(x - 0.5 * self.cols * self.resolution, y - 0.5 * self.rows * self.resolution)
        return replace(
            self,
            origin_x=self.origin_x + col * self.resolution,
            origin_y=self.origin_y + row * self.resolution,
        )

    def bounds_around(self, x: float, y: float, reach: float) -> CellBounds:
        """Compute the block of cells of a square around a point, cut to the window.

        Args:
            x: Position in the costmap's frame [m].
            y: Position in the costmap's frame [m].
            reach: Half the side of the square [m].
        """
        row_min, col_min = self.cell_of(x - reach, y - reach)
        row_max, col_max = self.cell_of(x + reach, y + reach)
        return self.cut(CellBounds(row_min, row_max + 1, col_min, col_max + 1))

    def grown(self, bounds: CellBounds, cells: int) -> CellBounds:
        """Grow a block on each side, cut to the window.

        Args:
            bounds: Block of cells.
            cells: Number of rows and columns to add on each side.
        """
        return self.cut(
            CellBounds(
                bounds.row_min - cells, bounds.row_max + cells, bounds.col_min - cells, bounds.col_max + cells
            )
        )

    def cut(self, bounds: CellBounds) -> CellBounds:
        """Cut a block to the window."""
        return CellBounds(
            min(max(bounds.row_min, 0), self.rows),
            min(max(bounds.row_max, 0), self.rows),
            min(max(bounds.col_min, 0), self.cols),
            min(max(bounds.col_max, 0), self.cols),
        )

    @property
    def everything(self) -> CellBounds:
        """Block of all cells."""
        return CellBounds(0, self.rows, 0, self.cols)


__getattr__ = deprecated_names(__name__, {"Bounds": "CellBounds", "Window": "CostmapWindow"})
