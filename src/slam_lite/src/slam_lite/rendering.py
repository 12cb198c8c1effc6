"""Drawing the map: every key scan's beams as evidence of free and occupied cells.

A cell is occupied if the share of hits among the beams that reached it exceeds a threshold (Haehnel's
counting model as used by gmapping). Counts are sums over scans, so a scan whose pose has changed is taken out
and put in anew.
"""

import math
from dataclasses import dataclass
from typing import List, Sequence, Tuple

import numba
import numpy as np

from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, Pose2, Scan, wrap

_GROWTH = 10.0
_SIZE_MULTIPLE = 32


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


class MapRenderer:
    """Counts beams per cell and turns the counts into a grid."""

    def __init__(self, resolution: float, occupied_threshold: float):
        self._resolution = resolution
        self._threshold = occupied_threshold
        self._placed: List[np.ndarray] = []
        self._corner = np.zeros(2, dtype=np.int64)
        self._counts = np.zeros((2, 0, 0), dtype=np.uint16)

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

    def grid(self) -> OccupancyGrid:
        """The map of all scans counted so far, as large as what they reached."""
        hits, visits = self._counts
        rows, cols = (np.flatnonzero(visits.any(axis=axis)) for axis in (1, 0))
        if len(rows) == 0:
            return OccupancyGrid(np.full((1, 1), UNKNOWN, dtype=np.int8), self._resolution)
        row, col = rows[0], cols[0]
        hits, visits = (part[row : rows[-1] + 1, col : cols[-1] + 1] for part in (hits, visits))
        cells = _judged(hits, visits, self._threshold)
        x, y = (self._corner + [col, row]) * self._resolution
        return OccupancyGrid(cells, self._resolution, Pose2(float(x), float(y), 0.0))

    def _count(self, beams: Beams, pose: np.ndarray, amount: int) -> None:
        start, ends = self._in_cells(beams, pose)
        _trace(self._counts, start - self._corner, ends - self._corner, beams.marks, amount)

    def _in_cells(self, beams: Beams, pose: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """Where a scan's beams start, (2,), and end, (N, 2), in cells from the map's origin."""
        base_in_map = Pose2.from_array(pose)
        start = base_in_map.transform_points(beams.laser_xy[None])[0]
        return start / self._resolution, base_in_map.transform_points(beams.ends_xy) / self._resolution

    def _cover(self, placed: Sequence[Tuple[Beams, np.ndarray]]) -> None:
        """Makes room for the beams of some scans at their poses, for all at once: large maps take memory."""
        if not placed:
            return
        extents = []
        for beams, pose in placed:
            cells = np.vstack(self._in_cells(beams, pose))
            extents.append((cells.min(axis=0), cells.max(axis=0)))
        lowest = np.floor(np.min([low for low, _ in extents], axis=0)).astype(np.int64) - 1
        highest = np.floor(np.max([high for _, high in extents], axis=0)).astype(np.int64) + 2
        if self._counts.size == 0:
            self._corner = lowest
            self._counts = np.zeros((2, *(highest - lowest)[::-1]), dtype=np.uint16)
            return
        end = self._corner + np.array(self._counts.shape[:0:-1])
        if (lowest >= self._corner).all() and (highest <= end).all():
            return
        margin = round(_GROWTH / self._resolution)
        new_corner = np.where(lowest < self._corner, lowest - margin, self._corner)
        new_end = np.where(highest > end, highest + margin, end)
        counts = np.zeros((2, *(new_end - new_corner)[::-1]), dtype=np.uint16)
        col, row = self._corner - new_corner
        counts[:, row : row + self._counts.shape[1], col : col + self._counts.shape[2]] = self._counts
        self._corner, self._counts = new_corner, counts


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
def _trace(counts, start, ends, marks, amount):
    """Adds ``amount`` to the visits, counts[1], of each beam's cells and the hits, counts[0], of its end."""
    for i in range(len(ends)):
        col, row = int(math.floor(start[0])), int(math.floor(start[1]))
        end_col, end_row = int(math.floor(ends[i, 0])), int(math.floor(ends[i, 1]))
        dx, dy = ends[i, 0] - start[0], ends[i, 1] - start[1]
        col_step, row_step = (1 if dx > 0 else -1), (1 if dy > 0 else -1)
        next_col = (col + (dx > 0) - start[0]) / dx if dx != 0.0 else np.inf
        next_row = (row + (dy > 0) - start[1]) / dy if dy != 0.0 else np.inf
        col_delta = abs(1.0 / dx) if dx != 0.0 else np.inf
        row_delta = abs(1.0 / dy) if dy != 0.0 else np.inf
        for _ in range(abs(end_col - col) + abs(end_row - row)):
            counts[1, row, col] += amount
            if next_col < next_row:
                next_col, col = next_col + col_delta, col + col_step
            else:
                next_row, row = next_row + row_delta, row + row_step
        if marks[i]:
            counts[1, end_row, end_col] += amount
            counts[0, end_row, end_col] += amount


@numba.njit(cache=True, nogil=True)
def _judged(hits, visits, threshold):
    """The cells, FREE, OCCUPIED or UNKNOWN, that these counts speak for."""
    cells = np.full(hits.shape, UNKNOWN, dtype=np.int8)
    for row in range(cells.shape[0]):
        for col in range(cells.shape[1]):
            if visits[row, col] > 0:
                cells[row, col] = OCCUPIED if hits[row, col] > threshold * visits[row, col] else FREE
    return cells
