"""Where a costmap lies in its frame."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple, Tuple

from planar.deprecation import deprecated_names


class CellBounds(NamedTuple):
    """A block of cells: rows row_min..row_max-1, columns col_min..col_max-1."""

    row_min: int
    row_max: int
    col_min: int
    col_max: int

    @property
    def slices(self) -> Tuple[slice, slice]:
        """Of its rows and its columns, to index arrays with."""
        return slice(self.row_min, self.row_max), slice(self.col_min, self.col_max)


NO_CELLS = CellBounds(0, 0, 0, 0)


def union(a: CellBounds, b: CellBounds) -> CellBounds:
    """The smallest block that holds both."""
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
    """An axis-aligned block of cells; (origin_x, origin_y) is the lower left corner of (0, 0), metres."""

    rows: int
    cols: int
    resolution: float
    origin_x: float = 0.0
    origin_y: float = 0.0

    def cell_of(self, x: float, y: float) -> Tuple[int, int]:
        """(row, col) of a point; it may lie outside."""
        return (
            math.floor((y - self.origin_y) / self.resolution),
            math.floor((x - self.origin_x) / self.resolution),
        )

    def contains(self, x: float, y: float) -> bool:
        row, col = self.cell_of(x, y)
        return 0 <= row < self.rows and 0 <= col < self.cols

    def is_like(self, other: "CostmapWindow") -> bool:
        """Whether both have as many cells of the same size, wherever they lie."""
        return replace(self, origin_x=other.origin_x, origin_y=other.origin_y) == other

    def centred_on(self, x: float, y: float) -> "CostmapWindow":
        """The same window moved by whole cells so that its middle is at the point."""
        row, col = self.cell_of(x - 0.5 * self.cols * self.resolution, y - 0.5 * self.rows * self.resolution)
        return replace(
            self,
            origin_x=self.origin_x + col * self.resolution,
            origin_y=self.origin_y + row * self.resolution,
        )

    def bounds_around(self, x: float, y: float, reach: float) -> CellBounds:
        """Cells within a square of half side ``reach`` around a point, cut to the window."""
        row_min, col_min = self.cell_of(x - reach, y - reach)
        row_max, col_max = self.cell_of(x + reach, y + reach)
        return self.cut(CellBounds(row_min, row_max + 1, col_min, col_max + 1))

    def grown(self, bounds: CellBounds, cells: int) -> CellBounds:
        """The block and all within so many cells of it, cut to the window."""
        return self.cut(
            CellBounds(
                bounds.row_min - cells, bounds.row_max + cells, bounds.col_min - cells, bounds.col_max + cells
            )
        )

    def cut(self, bounds: CellBounds) -> CellBounds:
        return CellBounds(
            min(max(bounds.row_min, 0), self.rows),
            min(max(bounds.row_max, 0), self.rows),
            min(max(bounds.col_min, 0), self.cols),
            min(max(bounds.col_max, 0), self.cols),
        )

    @property
    def everything(self) -> CellBounds:
        return CellBounds(0, self.rows, 0, self.cols)


__getattr__ = deprecated_names(__name__, {"Bounds": "CellBounds", "Window": "CostmapWindow"})
