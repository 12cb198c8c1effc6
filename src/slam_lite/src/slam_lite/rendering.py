"""Drawing the map: every key scan's beams as evidence of free and occupied cells.

A cell is occupied if the share of hits among the beams that reached it exceeds a threshold (Haehnel's
counting model as used by gmapping). Counts are sums over scans, so a scan whose pose has changed is taken out
and put in anew. A map that is drawn but once is drawn in bands, which never take the memory of all of it.
"""

import math
from dataclasses import dataclass
from typing import Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from planar import UNKNOWN, OccupancyGrid, Pose2, Scan, wrap
from planar.geometry.grid import BandedGrid
from slam_lite.tiles import TILE, Box, TileCounts, around

_GROWTH = 10.0
_SIZE_MULTIPLE = 32
# Cells of a band, which with their counts take five bytes each and session where all of them were seen.
_BAND_CELLS = 4_000_000
# (xmin, ymin, xmax, ymax), metres.
Extent = Tuple[float, float, float, float]
# The map of nothing: a cell.
_NOTHING = Box(0, 0, 1, 1)
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
        self._resolution, self._threshold = resolution, occupied_threshold
        self._before, self._now = (ScanCounter(resolution) for _ in range(2))

    def update(self, evidence: Evidence) -> None:
        """Brings the map up to date; ``evidence``: as many ``older`` scans as ever."""
        beams, poses, older = evidence
        self._before.update(beams[:older], poses[:older])
        self._now.update(beams[older:], poses[older:])

    def grid(self, extent: Optional[Extent] = None) -> OccupancyGrid:
        """The map as it is now, and where that was not seen, as it was; on a canvas, if one is given."""
        now, before = self._now.counts, None if self._before.is_empty else self._before.counts
        box = _box_of(now, before)
        if extent is not None:
            box = on_canvas(box, extent, self._resolution)
        cells = _judged(now, before, box, self._threshold)
        return OccupancyGrid(cells, self._resolution, _origin(box, self._resolution))


class ScanCounter:
    """Counts the beams of one session's key scans per cell."""

    def __init__(self, resolution: float):
        self._resolution = resolution
        self._placed: List[np.ndarray] = []
        self.counts = TileCounts(np.zeros(2, dtype=np.int64), (0, 0))

    @property
    def is_empty(self) -> bool:
        """Whether no scan was counted yet."""
        return not self._placed

    def update(self, beams: Sequence[Beams], poses: np.ndarray) -> None:
        """Brings the counts up to date with the scans' present poses (N, 3) in the map."""
        news = [i for i in range(len(beams)) if i >= len(self._placed) or self._has_moved(i, poses[i])]
        if news:
            bounds = _bounds([beams[i] for i in news], poses[news], self._resolution)
            self.counts.cover(*_tiles_around(bounds))
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

    def _count(self, beams: Beams, pose: np.ndarray, amount: int) -> None:
        self.counts.count(*_in_cells(beams, pose, self._resolution), beams.marks, amount)


def drawn_in_bands(
    evidence: Evidence, resolution: float, occupied_threshold: float, most_cells: int = _BAND_CELLS
) -> BandedGrid:
    """The map as a SessionRenderer draws it, in bands of at most ``most_cells``, or as low as a tile.

    Each is drawn when it is asked for, from the beams that reach it.
    """
    beams, poses, older = evidence
    now = _SessionScans(beams[older:], poses[older:], resolution)
    before = _SessionScans(beams[:older], poses[:older], resolution) if older else None
    box = _box_of(now, before)
    rows, cols = box.shape
    bands = _bands(now, before, box, occupied_threshold, max(1, most_cells // (TILE * cols)))
    return BandedGrid(rows, cols, resolution, _origin(box, resolution), bands)


def _bands(
    now: "_SessionScans", before: "Optional[_SessionScans]", box: Box, threshold: float, height: int
) -> Iterator[np.ndarray]:
    """The cells of ``box`` from the top band, ``height`` tiles high, to the lowest."""
    for end in range(-(-box.end_row // TILE), box.row // TILE, -height):
        yield _band(now, before, box, threshold, max(end - height, box.row // TILE), end)


def _band(
    now: "_SessionScans", before: "Optional[_SessionScans]", box: Box, threshold: float, first: int, end: int
) -> np.ndarray:
    """What of ``box`` lies between two rows of tiles."""
    band = Box(max(first * TILE, box.row), box.col, min(end * TILE, box.end_row), box.end_col)
    older = None if before is None else before.counted(first, end)
    return _judged(now.counted(first, end), older, band, threshold)


class _SessionScans:
    """The key scans of one session, to be counted as a ScanCounter does, but only in some rows of tiles.

    ``box``: around all cells that they reach, None if there is none.
    """

    def __init__(self, beams: Sequence[Beams], poses: np.ndarray, resolution: float):
        self._beams, self._poses, self._resolution = beams, poses, resolution
        bounds = _bounds(beams, poses, resolution)
        self._corner, end = _tiles_around(bounds)
        self._cols = int(end[0] - self._corner[0])
        # Columns and rows (N, 2) where each scan begins and ends; rounding may lead a beam astray by one.
        self._first = np.floor(bounds[:, 0]).astype(np.int64) - 1
        self._end = np.floor(bounds[:, 1]).astype(np.int64) + 2
        self.box = self._reached()

    def counted(self, first: int, end: int) -> TileCounts:
        """The counts from one row of tiles to the one before another."""
        is_there = (self._first[:, 1] < end * TILE) & (self._end[:, 1] > first * TILE)
        return self._counts(first, end, np.flatnonzero(is_there).tolist())

    def _counts(self, first: int, end: int, numbers: Sequence[int]) -> TileCounts:
        counts = TileCounts(self._corner, (end - first, self._cols), first - int(self._corner[1]))
        for i in numbers:
            beams = self._beams[i]
            counts.count(*_in_cells(beams, self._poses[i], self._resolution), beams.marks, 1)
        return counts

    def _reached(self) -> Optional[Box]:
        """Only the outermost scans have to be followed for it."""
        box, is_left = None, np.ones(len(self._beams), dtype=bool)
        while is_left.any():
            beyond = np.where(is_left, self._beyond(box), 0)
            outermost = int(np.argmax(beyond))
            if beyond[outermost] == 0:
                break
            first, end = self._first[outermost, 1] // TILE, -(-self._end[outermost, 1] // TILE)
            box = around(box, self._counts(int(first), int(end), [outermost]).box)
            is_left[outermost] = False
        return box

    def _beyond(self, box: Optional[Box]) -> np.ndarray:
        """By how many cells (N,) each scan may reach out of a box."""
        if box is None:
            return np.ones(len(self._beams), dtype=np.int64)
        before, after = [box.col, box.row] - self._first, self._end - [box.end_col, box.end_row]
        return np.maximum(before, after).max(axis=1, initial=0)


def _bounds(beams: Sequence[Beams], poses: np.ndarray, resolution: float) -> np.ndarray:
    """First and last column and row (N, 2, 2) of where N scans lie, in cells from the map's origin."""
    bounds = np.empty((len(beams), 2, 2))
    for i, (scan, pose) in enumerate(zip(beams, poses)):
        cells = np.vstack(_in_cells(scan, pose, resolution))
        bounds[i] = cells.min(axis=0), cells.max(axis=0)
    return bounds


def _tiles_around(bounds: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The first tile (2,), column and row, of those in which scans between ``bounds`` lie, and the end."""
    if len(bounds) == 0:
        return np.zeros(2, dtype=np.int64), np.zeros(2, dtype=np.int64)
    lowest = np.floor(bounds[:, 0].min(axis=0) / TILE).astype(np.int64) - 1
    return lowest, np.floor(bounds[:, 1].max(axis=0) / TILE).astype(np.int64) + 2


def _in_cells(beams: Beams, pose: np.ndarray, resolution: float) -> Tuple[np.ndarray, np.ndarray]:
    """Where a scan's beams start, (2,), and end, (N, 2), in cells from the map's origin."""
    base_in_map = Pose2.from_array(pose)
    start = base_in_map.transform_points(beams.laser_xy[None])[0]
    return start / resolution, base_in_map.transform_points(beams.ends_xy) / resolution


def _box_of(now: "Union[TileCounts, _SessionScans]", before: "Union[TileCounts, _SessionScans, None]") -> Box:
    """The cells of a map of two sessions; what saw nothing has the one cell of the map's origin."""
    box = around(*(each.box or _NOTHING for each in (now, before) if each is not None))
    assert box is not None
    return box


def _judged(now: TileCounts, before: Optional[TileCounts], box: Box, threshold: float) -> np.ndarray:
    """The cells of ``box`` as now, or as before where that saw too little."""
    cells = np.full(box.shape, UNKNOWN, dtype=np.int8)
    now.judge(cells, box, threshold, 1)
    if before is not None:
        before.judge(cells, box, threshold, 1)
        now.judge(cells, box, threshold, _ENOUGH_VISITS)
    return cells


def _origin(box: Box, resolution: float) -> Pose2:
    return Pose2(float(box.col * resolution), float(box.row * resolution))


def on_canvas(box: Box, extent: Extent, resolution: float) -> Box:
    """The canvas that gmapping would draw a map on: ``extent`` grows by steps of 10 m where the map's ``box``
    is larger; its sides are multiples of 32 cells.
    """
    corner, end = np.array([box.col, box.row]), np.array([box.end_col, box.end_row])
    lowest = np.floor(np.array(extent[:2]) / resolution).astype(np.int64)
    highest = np.ceil(np.array(extent[2:]) / resolution).astype(np.int64)
    step = round(_GROWTH / resolution)
    lowest -= np.maximum(0, -((corner - lowest) // step)) * step
    highest += np.maximum(0, -((highest - end) // step)) * step
    cols, rows = -((lowest - highest) // _SIZE_MULTIPLE) * _SIZE_MULTIPLE
    col, row = lowest.tolist()
    return Box(row, col, row + int(rows), col + int(cols))
