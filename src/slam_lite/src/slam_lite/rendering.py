"""Rendering of the map: the beams of all keyframes as evidence of free and occupied cells.

A cell is occupied if the share of hits among the beams that reached it exceeds a threshold (Haehnel's
counting model as used by gmapping). Counts are sums over scans, so a scan whose pose has changed is
subtracted and added again. A map that is rendered only once is rendered in bands, so that its counts are
never all in memory.
"""

import math
from dataclasses import dataclass
from typing import Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from planar import UNKNOWN, OccupancyGrid, Pose2, Scan, wrap
from planar.geometry.grid import BandedGrid
from slam_lite.tiles import TILE, CellBox, TileCounts, bounding_box

_GROWTH = 10.0
_SIZE_MULTIPLE = 32
# Cells of a band; with counts they take up to five bytes each and session.
_BAND_CELLS = 4_000_000
# (xmin, ymin, xmax, ymax), metres.
Extent = Tuple[float, float, float, float]
# The map without beams: one cell.
_ORIGIN_CELL = CellBox(0, 0, 1, 1)
# Visits of a cell from which on the present session overrides older ones.
_OVERRIDING_VISITS = 5


@dataclass(frozen=True, eq=False)
class ScanBeams:
    """Beams of one scan in the base frame; all of them clear the cells up to their ends.

    Attributes:
        laser_xy: (2,), start of all beams [m].
        ends_xy: float32 (N, 2), ends of the beams [m].
        marks: bool (N,), whether each beam marks an obstacle at its end.
    """

    laser_xy: np.ndarray
    ends_xy: np.ndarray
    marks: np.ndarray


def beams_of(scan: Scan, max_range: float, usable_range: float) -> ScanBeams:
    """Convert a scan to beams; "no return" (inf) counts as ``range_max``.

    Args:
        scan: The scan.
        max_range: Range above which readings are dropped [m].
        usable_range: Range up to which readings above it clear cells, without marking an obstacle [m].
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
    return ScanBeams(laser_xy, ends_xy.astype(np.float32), marks)


def without_far_beams(beams: ScanBeams, max_range: float) -> ScanBeams:
    """Drop the beams that end beyond a range [m]; returns ``beams`` itself if there are none."""
    reach = np.hypot(*(beams.ends_xy - beams.laser_xy).T)
    kept = reach <= max_range
    if kept.all():
        return beams
    return ScanBeams(beams.laser_xy, beams.ends_xy[kept], beams.marks[kept])


class Evidence(NamedTuple):
    """Input of map rendering.

    Attributes:
        beams: Beams of all keyframes, N.
        poses: (N, 3), poses of all keyframes in the map frame.
        older: Number of keyframes of earlier sessions, which are the first ones.
    """

    beams: Sequence[ScanBeams]
    poses: np.ndarray
    older: int = 0


class SessionRenderer:
    """Renders the keyframes of several sessions; the present session overrides earlier ones.

    It does so in cells that it saw often enough. So furniture that was moved between sessions is only at its
    present place, however often it was seen elsewhere.
    """

    def __init__(self, resolution: float, occupied_threshold: float):
        """Create a renderer without keyframes.

        Args:
            resolution: Cell size [m].
            occupied_threshold: Share of hits, 0 to 1, above which a cell is occupied.
        """
        self._resolution, self._threshold = resolution, occupied_threshold
        self._before, self._now = (BeamCounter(resolution) for _ in range(2))

    def update(self, evidence: Evidence) -> None:
        """Update the beam counts.

        Args:
            evidence: Beams and poses of all keyframes; ``evidence.older`` must not change between calls.
        """
        beams, poses, older = evidence
        self._before.update(beams[:older], poses[:older])
        self._now.update(beams[older:], poses[older:])

    def grid(self, extent: Optional[Extent] = None) -> OccupancyGrid:
        """Return the map.

        Args:
            extent: Least extent of the map, ``(xmin, ymin, xmax, ymax)`` in the map frame [m].
        """
        now, before = self._now.counts, None if self._before.is_empty else self._before.counts
        box = _box_of(now, before)
        if extent is not None:
            box = expand_to_extent(box, extent, self._resolution)
        cells = _classified(now, before, box, self._threshold)
        return OccupancyGrid(cells, self._resolution, _origin(box, self._resolution))


class BeamCounter:
    """Counts the beams of one session's keyframes per cell.

    Attributes:
        counts: Visits and hits of each cell.
    """

    def __init__(self, resolution: float):
        """Create counts without keyframes.

        Args:
            resolution: Cell size [m].
        """
        self._resolution = resolution
        self._placed: List[np.ndarray] = []
        self._counted: List[ScanBeams] = []
        self.counts = TileCounts(np.zeros(2, dtype=np.int64), (0, 0))

    @property
    def is_empty(self) -> bool:
        """Whether no scan was counted yet."""
        return not self._placed

    def update(self, beams: Sequence[ScanBeams], poses: np.ndarray) -> None:
        """Recount the keyframes that are new, have moved or have other beams.

        Args:
            beams: Beams of all keyframes of the session, N.
            poses: (N, 3), their present poses in the map frame.
        """
        known = len(self._placed)
        changed = [i for i in range(len(beams)) if i >= known or self._has_changed(i, beams[i], poses[i])]
        if changed:
            bounds = _bounds([beams[i] for i in changed], poses[changed], self._resolution)
            self.counts.cover(*_tiles_around(bounds))
        for i in changed:
            if i < len(self._placed):
                self._count(self._counted[i], self._placed[i], -1)
                self._placed[i], self._counted[i] = poses[i].copy(), beams[i]
            else:
                self._placed.append(poses[i].copy())
                self._counted.append(beams[i])
            self._count(beams[i], poses[i], 1)

    def _has_changed(self, i: int, beams: ScanBeams, pose: np.ndarray) -> bool:
        x, y, turn = pose - self._placed[i]
        has_moved = math.hypot(x, y) > 0.5 * self._resolution or abs(wrap(float(turn))) > 0.005
        return has_moved or beams is not self._counted[i]

    def _count(self, beams: ScanBeams, pose: np.ndarray, amount: int) -> None:
        self.counts.count(*_in_cells(beams, pose, self._resolution), beams.marks, amount)


def render_in_bands(
    evidence: Evidence, resolution: float, occupied_threshold: float, max_cells: int = _BAND_CELLS
) -> BandedGrid:
    """Render the same map as a SessionRenderer in bands, each computed on use.

    Args:
        evidence: Beams and poses of all keyframes.
        resolution: Cell size [m].
        occupied_threshold: Share of hits, 0 to 1, above which a cell is occupied.
        max_cells: Largest number of cells of a band; a band is at least as high as a tile.
    """
    beams, poses, older = evidence
    now = _SessionScans(beams[older:], poses[older:], resolution)
    before = _SessionScans(beams[:older], poses[:older], resolution) if older else None
    box = _box_of(now, before)
    rows, cols = box.shape
    bands = _bands(now, before, box, occupied_threshold, max(1, max_cells // (TILE * cols)))
    return BandedGrid(rows, cols, resolution, _origin(box, resolution), bands)


def _bands(
    now: "_SessionScans", before: "Optional[_SessionScans]", box: CellBox, threshold: float, height: int
) -> Iterator[np.ndarray]:
    """The bands of ``box``, ``height`` tiles high, from the top."""
    for end in range(-(-box.end_row // TILE), box.row // TILE, -height):
        yield _band(now, before, box, threshold, max(end - height, box.row // TILE), end)


def _band(
    now: "_SessionScans",
    before: "Optional[_SessionScans]",
    box: CellBox,
    threshold: float,
    first: int,
    end: int,
) -> np.ndarray:
    """The part of ``box`` between two rows of tiles."""
    band = CellBox(max(first * TILE, box.row), box.col, min(end * TILE, box.end_row), box.end_col)
    older = None if before is None else before.counted(first, end)
    return _classified(now.counted(first, end), older, band, threshold)


class _SessionScans:
    """The keyframes of one session, to be counted as by BeamCounter, but only in some rows of tiles.

    Attributes:
        box: Around all cells that they reach, None if there are none.
    """

    def __init__(self, beams: Sequence[ScanBeams], poses: np.ndarray, resolution: float):
        self._beams, self._poses, self._resolution = beams, poses, resolution
        bounds = _bounds(beams, poses, resolution)
        self._corner, end = _tiles_around(bounds)
        self._cols = int(end[0] - self._corner[0])
        # First and last column and row (N, 2) of each scan; rounding may move a beam by one cell.
        self._first = np.floor(bounds[:, 0]).astype(np.int64) - 1
        self._end = np.floor(bounds[:, 1]).astype(np.int64) + 2
        self.box = self._reached()

    def counted(self, first: int, end: int) -> TileCounts:
        """The counts in the rows of tiles from ``first`` to before ``end``."""
        is_inside = (self._first[:, 1] < end * TILE) & (self._end[:, 1] > first * TILE)
        return self._counts(first, end, np.flatnonzero(is_inside).tolist())

    def _counts(self, first: int, end: int, numbers: Sequence[int]) -> TileCounts:
        counts = TileCounts(self._corner, (end - first, self._cols), first - int(self._corner[1]))
        for i in numbers:
            beams = self._beams[i]
            counts.count(*_in_cells(beams, self._poses[i], self._resolution), beams.marks, 1)
        return counts

    def _reached(self) -> Optional[CellBox]:
        """The box; only the outermost scans have to be traced for it."""
        box, is_left = None, np.ones(len(self._beams), dtype=bool)
        while is_left.any():
            beyond = np.where(is_left, self._beyond(box), 0)
            outermost = int(np.argmax(beyond))
            if beyond[outermost] == 0:
                break
            first, end = self._first[outermost, 1] // TILE, -(-self._end[outermost, 1] // TILE)
            box = bounding_box(box, self._counts(int(first), int(end), [outermost]).box)
            is_left[outermost] = False
        return box

    def _beyond(self, box: Optional[CellBox]) -> np.ndarray:
        """By how many cells (N,) each scan may extend beyond a box."""
        if box is None:
            return np.ones(len(self._beams), dtype=np.int64)
        before, after = [box.col, box.row] - self._first, self._end - [box.end_col, box.end_row]
        return np.maximum(before, after).max(axis=1, initial=0)


def _bounds(beams: Sequence[ScanBeams], poses: np.ndarray, resolution: float) -> np.ndarray:
    """First and last column and row (N, 2, 2) of N scans, in cells from the map's origin."""
    bounds = np.empty((len(beams), 2, 2))
    for i, (scan, pose) in enumerate(zip(beams, poses)):
        cells = np.vstack(_in_cells(scan, pose, resolution))
        bounds[i] = cells.min(axis=0), cells.max(axis=0)
    return bounds


def _tiles_around(bounds: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The first tile (2,), column and row, of scans with these ``bounds``, and the one after the last."""
    if len(bounds) == 0:
        return np.zeros(2, dtype=np.int64), np.zeros(2, dtype=np.int64)
    lowest = np.floor(bounds[:, 0].min(axis=0) / TILE).astype(np.int64) - 1
    return lowest, np.floor(bounds[:, 1].max(axis=0) / TILE).astype(np.int64) + 2


def _in_cells(beams: ScanBeams, pose: np.ndarray, resolution: float) -> Tuple[np.ndarray, np.ndarray]:
    """Start (2,) and ends (N, 2) of a scan's beams, in cells from the map's origin."""
    base_in_map = Pose2.from_array(pose)
    start = base_in_map.transform_points(beams.laser_xy[None])[0]
    return start / resolution, base_in_map.transform_points(beams.ends_xy) / resolution


def _box_of(
    now: "Union[TileCounts, _SessionScans]", before: "Union[TileCounts, _SessionScans, None]"
) -> CellBox:
    """The cells of a map of two sessions; the cell at the origin if nothing was seen."""
    box = bounding_box(*(each.box or _ORIGIN_CELL for each in (now, before) if each is not None))
    assert box is not None
    return box


def _classified(now: TileCounts, before: Optional[TileCounts], box: CellBox, threshold: float) -> np.ndarray:
    """The cells of ``box`` by the present session, or by older ones where it saw too little."""
    cells = np.full(box.shape, UNKNOWN, dtype=np.int8)
    now.classify(cells, box, threshold, 1)
    if before is not None:
        before.classify(cells, box, threshold, 1)
        now.classify(cells, box, threshold, _OVERRIDING_VISITS)
    return cells


def _origin(box: CellBox, resolution: float) -> Pose2:
    return Pose2(float(box.col * resolution), float(box.row * resolution))


def expand_to_extent(box: CellBox, extent: Extent, resolution: float) -> CellBox:
    """Expand a map as gmapping does.

    Args:
        box: Cells of the map.
        extent: Least extent ``(xmin, ymin, xmax, ymax)`` [m], which grows by steps of 10 m where ``box`` is
            larger.
        resolution: Cell size [m].

    Returns:
        The expanded box, whose sides are multiples of 32 cells.
    """
    corner, end = np.array([box.col, box.row]), np.array([box.end_col, box.end_row])
    lowest = np.floor(np.array(extent[:2]) / resolution).astype(np.int64)
    highest = np.ceil(np.array(extent[2:]) / resolution).astype(np.int64)
    step = round(_GROWTH / resolution)
    lowest -= np.maximum(0, -((corner - lowest) // step)) * step
    highest += np.maximum(0, -((highest - end) // step)) * step
    cols, rows = -((lowest - highest) // _SIZE_MULTIPLE) * _SIZE_MULTIPLE
    col, row = lowest.tolist()
    return CellBox(row, col, row + int(rows), col + int(cols))
