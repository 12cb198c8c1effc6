"""Beam counts per cell, in tiles that are allocated only where beams have been."""

import math
from typing import NamedTuple, Optional, Tuple

import numba
import numpy as np

from planar import FREE, OCCUPIED

# Side of a tile, cells, and initial capacity in tiles.
TILE, _FIRST_TILES = 64, 256


class CellBox(NamedTuple):
    """Rectangle of cells, counted from the map's origin.

    Attributes:
        row: First row.
        col: First column.
        end_row: Row after the last one.
        end_col: Column after the last one.
    """

    row: int
    col: int
    end_row: int
    end_col: int

    @property
    def shape(self) -> Tuple[int, int]:
        """Number of rows and columns."""
        return self.end_row - self.row, self.end_col - self.col


def bounding_box(*boxes: Optional[CellBox]) -> Optional[CellBox]:
    """Compute the smallest box around all boxes that are not None; None if there are none."""
    firsts, ends = [box[:2] for box in boxes if box], [box[2:] for box in boxes if box]
    return CellBox(*map(min, *firsts, *firsts), *map(max, *ends, *ends)) if firsts else None


class TileCounts:
    """Number of beams that reached each cell (visits), and of those that ended there (hits).

    Attributes:
        corner: (2,), column and row of the first tile, in tiles from the map's origin.
    """

    def __init__(self, corner: np.ndarray, shape: Tuple[int, int], first_row: int = 0):
        """Create counts of 0.

        Args:
            corner: (2,), column and row of the first tile, in tiles from the map's origin.
            shape: Rows and columns of tiles; beams outside of them are not counted.
            first_row: First row of tiles to count, from the corner.
        """
        self.corner = corner
        self._first_row = first_row
        # Hits and visits (tiles, 2, rows, cols), and the tile at each position or -1.
        self._tiles = np.zeros((0, 2, TILE, TILE), dtype=np.uint16)
        self._used = 0
        self._index = np.full(shape, -1, dtype=np.int32)

    def cover(self, lowest: np.ndarray, highest: np.ndarray) -> None:
        """Extend the area.

        Args:
            lowest: (2,), column and row of the first tile to cover.
            highest: (2,), column and row after the last tile.
        """
        if self._index.size:
            end = self.corner + self._index.shape[::-1]
            lowest, highest = np.minimum(lowest, self.corner), np.maximum(highest, end)
            if (lowest == self.corner).all() and (highest == end).all():
                return
        index = np.full((highest - lowest)[::-1], -1, dtype=np.int32)
        col, row = self.corner - lowest
        index[row : row + self._index.shape[0], col : col + self._index.shape[1]] = self._index
        self.corner, self._index = lowest, index

    def count(self, start: np.ndarray, ends: np.ndarray, marks: np.ndarray, amount: int) -> None:
        """Count the beams of a scan.

        Args:
            start: (2,), column and row at which all beams start, in fractional cells from the map's origin.
            ends: (N, 2), columns and rows at which they end, in the same unit.
            marks: (N,), whether each beam marks an obstacle at its end.
            amount: 1 to add the beams, -1 to remove them.
        """
        start, ends = start - self.corner * TILE, ends - self.corner * TILE
        first = 0
        while first < len(ends):
            traced, self._used = _trace(
                self._tiles,
                self._index,
                self._first_row * TILE,
                self._used,
                start,
                ends[first:],
                marks[first:],
                amount,
            )
            first += traced
            if first < len(ends):
                self._tiles = _enlarged(self._tiles)

    @property
    def box(self) -> Optional[CellBox]:
        """All cells that beams have reached, None if there are none."""
        row, col, end_row, end_col = _extent(self._tiles, self._index)
        if end_row <= row:
            return None
        first_col, first_row = (self.corner + [0, self._first_row]) * TILE
        return CellBox(
            int(first_row + row), int(first_col + col), int(first_row + end_row), int(first_col + end_col)
        )

    def classify(self, cells: np.ndarray, box: CellBox, threshold: float, min_visits: int) -> None:
        """Classify the cells of a box that were visited often enough.

        Args:
            cells: (rows, cols) of the box; FREE or OCCUPIED is written into them.
            box: Position of the cells.
            threshold: Share of hits, 0 to 1, above which a cell is occupied.
            min_visits: Visits below which a cell is not changed.
        """
        col, row = (box.col, box.row) - (self.corner + [0, self._first_row]) * TILE
        _classify(self._tiles, self._index, threshold, min_visits, row, col, cells)


def _enlarged(tiles: np.ndarray) -> np.ndarray:
    """The tiles with at least as many empty ones added, which take no memory until they are used."""
    larger = np.zeros((2 * len(tiles) + _FIRST_TILES, *tiles.shape[1:]), dtype=tiles.dtype)
    larger[: len(tiles)] = tiles
    return larger


@numba.njit(cache=True, nogil=True)
def _trace(tiles, index, low, used, start, ends, marks, amount):
    """Add ``amount`` to the visits, [1], of each beam's cells and to the hits, [0], of its end.

    Only the rows from ``low`` on that ``index`` covers are counted; new tiles are taken from ``used`` on.
    Returns for how many beams there was room, and ``used`` afterwards.
    """
    high = low + len(index) * TILE
    for i in range(len(ends)):
        col, row = int(math.floor(start[0])), int(math.floor(start[1]))
        end_col, end_row = int(math.floor(ends[i, 0])), int(math.floor(ends[i, 1]))
        if max(row, end_row) < low - 1 or min(row, end_row) > high:
            continue
        steps = abs(end_col - col) + abs(end_row - row)
        if len(tiles) - used < steps // TILE + 4:
            return i, used
        dx, dy = ends[i, 0] - start[0], ends[i, 1] - start[1]
        col_step, row_step = (1 if dx > 0 else -1), (1 if dy > 0 else -1)
        next_col = (col + (dx > 0) - start[0]) / dx if dx != 0.0 else np.inf
        next_row = (row + (dy > 0) - start[1]) / dy if dy != 0.0 else np.inf
        col_delta = abs(1.0 / dx) if dx != 0.0 else np.inf
        row_delta = abs(1.0 / dy) if dy != 0.0 else np.inf
        past = high if row_step > 0 else low - 1
        for _ in range(steps):
            if low <= row < high:
                used = _add(tiles, index, used, row - low, col, 1, amount)
            elif row == past:
                break
            if next_col < next_row:
                next_col, col = next_col + col_delta, col + col_step
            else:
                next_row, row = next_row + row_delta, row + row_step
        if marks[i] and low <= end_row < high:
            used = _add(tiles, index, used, end_row - low, end_col, 1, amount)
            used = _add(tiles, index, used, end_row - low, end_col, 0, amount)
    return len(ends), used


@numba.njit(cache=True, nogil=True)
def _add(tiles, index, used, row, col, which, amount):
    tile = index[row // TILE, col // TILE]
    if tile < 0:
        tile = index[row // TILE, col // TILE] = used
        used += 1
    tiles[tile, which, row % TILE, col % TILE] += amount
    return used


@numba.njit(cache=True, nogil=True)
def _extent(tiles, index):
    """First visited row and column, and the ones after the last."""
    row, col, end_row, end_col = 2**31, 2**31, 0, 0
    for i in range(index.shape[0]):
        for j in range(index.shape[1]):
            if index[i, j] < 0:
                continue
            for r in range(TILE):
                for c in range(TILE):
                    if tiles[index[i, j], 1, r, c] > 0:
                        row, col = min(row, i * TILE + r), min(col, j * TILE + c)
                        end_row, end_col = max(end_row, i * TILE + r + 1), max(end_col, j * TILE + c + 1)
    return row, col, end_row, end_col


@numba.njit(cache=True, nogil=True)
def _classify(tiles, index, threshold, min_visits, first_row, first_col, cells):
    """Classify ``cells``, the first of which lies ``first_row`` and ``first_col`` from the tiles' first."""
    rows, cols = index.shape[0] * TILE, index.shape[1] * TILE
    for row in range(max(0, first_row), min(rows, first_row + cells.shape[0])):
        for col in range(max(0, first_col), min(cols, first_col + cells.shape[1])):
            tile = index[row // TILE, col // TILE]
            if tile < 0:
                continue
            hits, visits = tiles[tile, 0, row % TILE, col % TILE], tiles[tile, 1, row % TILE, col % TILE]
            if visits >= min_visits:
                cells[row - first_row, col - first_col] = OCCUPIED if hits > threshold * visits else FREE
