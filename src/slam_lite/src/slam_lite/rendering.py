"""Drawing the map: every key scan's beams as evidence of free and occupied cells.

A cell is occupied if the share of hits among the beams that reached it exceeds a threshold (Haehnel's
counting model as used by gmapping). Counts are sums over scans, so a scan whose pose has changed is taken out
and put in anew. They are kept in tiles, and only where a beam has been: of a large site little is ever seen.
"""

import math
from dataclasses import dataclass
from typing import List, NamedTuple, Sequence, Tuple

import numba
import numpy as np

from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, Pose2, Scan, wrap

_GROWTH = 10.0
# Side of a tile, cells, and how many there is room for at first.
_TILE, _FIRST_TILES = 64, 256
_SIZE_MULTIPLE = 32
# From so many beams on, the present session knows a cell, whatever older ones say.
_ENOUGH_VISITS = 5


@dataclass(frozen=True, eq=False)
class Beams:
    """The beams of one scan in the base frame: from ``laser_xy`` (2,) to ``ends_xy`` (N, 2), float32, metres.

    ``marks``: bool (N,), whether the beam met something at its end; all beams clear the way to it.
    """

    laser_xy: np.ndarray
    ends_xy: np.ndarray
    marks: np.ndarray


def beams_of(scan: Scan, max_range: float, usable_range: float) -> Beams:
    """The beams of ``scan``. Readings above ``max_range`` are dropped; those between ``usable_range`` and
    ``max_range`` clear the way up to ``usable_range`` and mark nothing. "Nothing met" counts as range_max.
    """
    ranges = np.where(np.isposinf(scan.ranges), scan.range_max, scan.ranges).astype(np.float64)
    with np.errstate(invalid="ignore"):
        used = (ranges >= max(scan.range_min, 1e-3)) & (ranges <= max_range)
    ranges, angles = ranges[used], scan.angles[used]
    marks = ranges < usable_range
    reach = np.minimum(ranges, usable_range)
    ends_xy = scan.laser_in_base.transform_points(
        np.column_stack((reach * np.cos(angles), reach * np.sin(angles)))
    )
    laser_xy = np.array([scan.laser_in_base.x, scan.laser_in_base.y])
    return Beams(laser_xy, ends_xy.astype(np.float32), marks)


class Evidence(NamedTuple):
    """What a map is drawn from: the ``beams`` of N key scans and their ``poses`` (N, 3).

    The first ``older`` ones are of sessions before the present one.
    """

    beams: Sequence[Beams]
    poses: np.ndarray
    older: int = 0


class SessionRenderer:
    """Draws the key scans of several sessions: what the present one has seen enough of is as it says.

    So furniture that has moved since is drawn where it is now, however often it was seen before.
    """

    def __init__(self, resolution: float, occupied_threshold: float):
        self._before, self._now = (MapRenderer(resolution, occupied_threshold) for _ in range(2))

    def update(self, evidence: Evidence) -> None:
        """Brings the map up to date; ``evidence``: as many ``older`` scans as ever."""
        beams, poses, older = evidence
        self._before.update(beams[:older], poses[:older])
        self._now.update(beams[older:], poses[older:])

    def grid(self) -> OccupancyGrid:
        """The map as it is now, and where that was not seen, as it was."""
        if self._before.is_empty:
            return self._now.grid()
        return overlaid([self._now.grid(), self._before.grid(), self._now.grid(_ENOUGH_VISITS)])


class MapRenderer:
    """Counts beams per cell and turns the counts into a grid."""

    def __init__(self, resolution: float, occupied_threshold: float):
        self._resolution = resolution
        self._threshold = occupied_threshold
        self._placed: List[np.ndarray] = []
        # Hits and visits (tiles, 2, rows, cols), the number of each place's tile or -1, and the first place.
        self._tiles = np.zeros((0, 2, _TILE, _TILE), dtype=np.uint16)
        self._used = 0
        self._index = np.empty((0, 0), dtype=np.int32)
        self._corner = np.zeros(2, dtype=np.int64)

    @property
    def is_empty(self) -> bool:
        """Whether no scan was counted yet."""
        return not self._placed

    def update(self, beams: Sequence[Beams], poses: np.ndarray) -> None:
        """Brings the counts up to date with the scans' present poses (N, 3) in the map."""
        news = [i for i in range(len(beams)) if i >= len(self._placed) or self._has_moved(i, poses[i])]
        self._cover([(beams[i], poses[i]) for i in news])
        for i in news:
            if i < len(self._placed):
                self._count(beams[i], self._placed[i], -1)
                self._placed[i] = poses[i].copy()
            else:
                self._placed.append(poses[i].copy())
            self._count(beams[i], poses[i], 1)

    def _has_moved(self, i: int, pose: np.ndarray) -> bool:
        x, y, turn = pose - self._placed[i]
        return math.hypot(x, y) > 0.5 * self._resolution or abs(wrap(float(turn))) > 0.005

    def grid(self, least_visits: int = 1) -> OccupancyGrid:
        """The map of all scans counted so far, as large as what they reached; fewer beams leave UNKNOWN."""
        row, col, end_row, end_col = _extent(self._tiles, self._index)
        if end_row <= row:
            return OccupancyGrid(np.full((1, 1), UNKNOWN, dtype=np.int8), self._resolution)
        box = row, col, end_row, end_col
        cells = _judged(self._tiles, self._index, self._threshold, least_visits, *box)
        x, y = (self._corner * _TILE + [col, row]) * self._resolution
        return OccupancyGrid(cells, self._resolution, Pose2(float(x), float(y), 0.0))

    def _count(self, beams: Beams, pose: np.ndarray, amount: int) -> None:
        start, ends = self._in_cells(beams, pose)
        start, ends = start - self._corner * _TILE, ends - self._corner * _TILE
        first = 0
        while first < len(ends):
            traced, self._used = _trace(
                self._tiles, self._index, self._used, start, ends[first:], beams.marks[first:], amount
            )
            first += traced
            if first < len(ends):
                self._tiles = _with_room(self._tiles)

    def _in_cells(self, beams: Beams, pose: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """Where a scan's beams start, (2,), and end, (N, 2), in cells from the map's origin."""
        base_in_map = Pose2.from_array(pose)
        start = base_in_map.transform_points(beams.laser_xy[None])[0]
        return start / self._resolution, base_in_map.transform_points(beams.ends_xy) / self._resolution

    def _cover(self, placed: Sequence[Tuple[Beams, np.ndarray]]) -> None:
        """Makes places for tiles where the beams of some scans are at their poses."""
        if not placed:
            return
        extents = []
        for beams, pose in placed:
            cells = np.vstack(self._in_cells(beams, pose))
            extents.append((cells.min(axis=0), cells.max(axis=0)))
        lowest = np.floor(np.min([low for low, _ in extents], axis=0) / _TILE).astype(np.int64) - 1
        highest = np.floor(np.max([high for _, high in extents], axis=0) / _TILE).astype(np.int64) + 2
        end = self._corner + self._index.shape[::-1]
        if self._index.size:
            lowest, highest = np.minimum(lowest, self._corner), np.maximum(highest, end)
            if (lowest == self._corner).all() and (highest == end).all():
                return
        index = np.full((highest - lowest)[::-1], -1, dtype=np.int32)
        col, row = self._corner - lowest
        index[row : row + self._index.shape[0], col : col + self._index.shape[1]] = self._index
        self._corner, self._index = lowest, index


def _with_room(tiles: np.ndarray) -> np.ndarray:
    """The tiles and at least as many empty ones, which take no memory until they are counted in."""
    larger = np.zeros((2 * len(tiles) + _FIRST_TILES, *tiles.shape[1:]), dtype=tiles.dtype)
    larger[: len(tiles)] = tiles
    return larger


def overlaid(grids: Sequence[OccupancyGrid]) -> OccupancyGrid:
    """Grids of one resolution as one, each over those before it wherever it knows something."""
    resolution = grids[0].resolution
    corners = [
        np.rint(np.array([grid.origin.x, grid.origin.y]) / resolution).astype(np.int64) for grid in grids
    ]
    ends = [corner + [grid.cols, grid.rows] for corner, grid in zip(corners, grids)]
    lowest, highest = np.min(corners, axis=0), np.max(ends, axis=0)
    cells = np.full((highest - lowest)[::-1], UNKNOWN, dtype=np.int8)
    for grid, corner in zip(grids, corners):
        col, row = corner - lowest
        below = cells[row : row + grid.rows, col : col + grid.cols]
        np.copyto(below, grid.cells, where=grid.cells != UNKNOWN)
    x, y = lowest * resolution
    return OccupancyGrid(cells, resolution, Pose2(float(x), float(y)))


def on_canvas(grid: OccupancyGrid, extent: Tuple[float, float, float, float]) -> OccupancyGrid:
    """The grid put on a canvas as gmapping would: ``extent`` is (xmin, ymin, xmax, ymax), metres, and grows
    by steps of 10 m where the grid is larger; sizes are multiples of 32 cells.
    """
    resolution = grid.resolution
    corner = np.rint(np.array([grid.origin.x, grid.origin.y]) / resolution).astype(np.int64)
    end = corner + np.array([grid.cols, grid.rows])
    lowest = np.floor(np.array(extent[:2]) / resolution).astype(np.int64)
    highest = np.ceil(np.array(extent[2:]) / resolution).astype(np.int64)
    step = round(_GROWTH / resolution)
    lowest -= np.maximum(0, -((corner - lowest) // step)) * step
    highest += np.maximum(0, -((highest - end) // step)) * step
    cols, rows = -((lowest - highest) // _SIZE_MULTIPLE) * _SIZE_MULTIPLE
    cells = np.full((rows, cols), UNKNOWN, dtype=np.int8)
    col, row = corner - lowest
    cells[row : row + grid.rows, col : col + grid.cols] = grid.cells
    x, y = lowest * resolution
    return OccupancyGrid(cells, resolution, Pose2(float(x), float(y)))


@numba.njit(cache=True, nogil=True)
def _trace(tiles, index, used, start, ends, marks, amount):
    """Adds ``amount`` to the visits, [1], of each beam's cells and the hits, [0], of its end.

    Takes tiles from ``used`` on where there are none yet. Returns how many beams there was room for, and
    ``used`` afterwards.
    """
    for i in range(len(ends)):
        col, row = int(math.floor(start[0])), int(math.floor(start[1]))
        end_col, end_row = int(math.floor(ends[i, 0])), int(math.floor(ends[i, 1]))
        steps = abs(end_col - col) + abs(end_row - row)
        if len(tiles) - used < steps // _TILE + 4:
            return i, used
        dx, dy = ends[i, 0] - start[0], ends[i, 1] - start[1]
        col_step, row_step = (1 if dx > 0 else -1), (1 if dy > 0 else -1)
        next_col = (col + (dx > 0) - start[0]) / dx if dx != 0.0 else np.inf
        next_row = (row + (dy > 0) - start[1]) / dy if dy != 0.0 else np.inf
        col_delta = abs(1.0 / dx) if dx != 0.0 else np.inf
        row_delta = abs(1.0 / dy) if dy != 0.0 else np.inf
        for _ in range(steps):
            used = _add(tiles, index, used, row, col, 1, amount)
            if next_col < next_row:
                next_col, col = next_col + col_delta, col + col_step
            else:
                next_row, row = next_row + row_delta, row + row_step
        if marks[i]:
            used = _add(tiles, index, used, end_row, end_col, 1, amount)
            used = _add(tiles, index, used, end_row, end_col, 0, amount)
    return len(ends), used


@numba.njit(cache=True, nogil=True)
def _add(tiles, index, used, row, col, which, amount):
    tile = index[row // _TILE, col // _TILE]
    if tile < 0:
        tile = index[row // _TILE, col // _TILE] = used
        used += 1
    tiles[tile, which, row % _TILE, col % _TILE] += amount
    return used


@numba.njit(cache=True, nogil=True)
def _extent(tiles, index):
    """First row and column that were visited, and the ones after the last."""
    row, col, end_row, end_col = 2**31, 2**31, 0, 0
    for i in range(index.shape[0]):
        for j in range(index.shape[1]):
            if index[i, j] < 0:
                continue
            for r in range(_TILE):
                for c in range(_TILE):
                    if tiles[index[i, j], 1, r, c] > 0:
                        row, col = min(row, i * _TILE + r), min(col, j * _TILE + c)
                        end_row, end_col = max(end_row, i * _TILE + r + 1), max(end_col, j * _TILE + c + 1)
    return row, col, end_row, end_col


@numba.njit(cache=True, nogil=True)
def _judged(tiles, index, threshold, least_visits, first_row, first_col, end_row, end_col):
    """The cells of a box, FREE, OCCUPIED or UNKNOWN, that these counts speak for."""
    cells = np.full((end_row - first_row, end_col - first_col), UNKNOWN, dtype=np.int8)
    for row in range(first_row, end_row):
        for col in range(first_col, end_col):
            tile = index[row // _TILE, col // _TILE]
            if tile < 0:
                continue
            hits, visits = tiles[tile, 0, row % _TILE, col % _TILE], tiles[tile, 1, row % _TILE, col % _TILE]
            if visits >= least_visits:
                cells[row - first_row, col - first_col] = OCCUPIED if hits > threshold * visits else FREE
    return cells
