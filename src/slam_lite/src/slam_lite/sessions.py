"""Maps that live on: a new session's scans replace what older ones say of the same places.

An older key scan is let go if nearly all that it saw has been seen often enough since, whether that is still
there or has gone. So a map grows with what there is to see, not with how often it is seen.
"""

from typing import Sequence, Tuple

import numba
import numpy as np

from planar import Pose2
from slam_lite.graph.condensing import condensed
from slam_lite.rendering import Beams
from slam_lite.state import MapState

# Size of the cells, metres, in which it is told what has been seen, and how many scans are enough of one.
_CELL, _ENOUGH = 0.2, 6
# A scan is kept for this share of what it saw.
_NEW_SHARE = 0.15
# Empty cells around the lasers and what their beams reached.
_MARGIN = 3


def renewed(state: MapState) -> MapState:
    """The state without the key scans of older sessions that newer ones have replaced."""
    if len(state.poses) == 0 or (state.sessions == state.sessions[-1]).all():
        return state
    kept = np.flatnonzero(_is_worth_keeping(state.beams, state.poses, state.sessions == state.sessions[-1]))
    return MapState(
        [state.surfaces[key] for key in kept],
        [state.beams[key] for key in kept],
        state.poses[kept],
        condensed(state.poses, state.edges, kept),
        state.base_in_map,
        state.sessions[kept],
    )


def _is_worth_keeping(beams: Sequence[Beams], poses: np.ndarray, is_newest: np.ndarray) -> np.ndarray:
    """Whether a key scan is of the newest session, or says of enough cells what few newer ones do, (N,)."""
    extents = [np.vstack(_in_cells(*scan)) for scan in zip(beams, poses) if len(scan[0].marks)]
    if not extents:
        return is_newest
    corner = np.floor(np.min([ends.min(axis=0) for ends in extents], axis=0)).astype(np.int64) - _MARGIN
    end = np.floor(np.max([ends.max(axis=0) for ends in extents], axis=0)).astype(np.int64) + _MARGIN
    counts = np.zeros(end - corner, dtype=np.uint8)
    is_kept = is_newest.copy()
    newest_first = np.concatenate((np.flatnonzero(is_newest), np.flatnonzero(~is_newest)[::-1]))
    for key in newest_first:
        if len(beams[key].marks) == 0:
            continue
        col, row = (np.unique(_cells_passed(*_in_cells(beams[key], poses[key])), axis=0) - corner).T
        seen = counts[col, row]
        if is_newest[key] or np.mean(seen < _ENOUGH) > _NEW_SHARE:
            is_kept[key] = True
            counts[col, row] = np.minimum(seen, 254) + 1
    return is_kept


def _in_cells(beams: Beams, pose: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Where a scan's beams start, (2,), and end, (N, 2), in cells."""
    in_map = Pose2.from_array(pose)
    start, ends = in_map.transform_points(beams.laser_xy[None])[0], in_map.transform_points(beams.ends_xy)
    return start / _CELL, ends / _CELL


@numba.njit(cache=True, nogil=True)
def _cells_passed(start, ends):
    """The cells (M, 2) that beams from ``start`` to ``ends``, in cells, pass in steps of one cell."""
    count = 0
    for i in range(len(ends)):
        count += int(np.hypot(ends[i, 0] - start[0], ends[i, 1] - start[1])) + 1
    passed = np.empty((count, 2), dtype=np.int64)
    at = 0
    for i in range(len(ends)):
        steps = int(np.hypot(ends[i, 0] - start[0], ends[i, 1] - start[1]))
        for step in range(1, steps + 2):
            share = min(1.0, step / max(steps, 1))
            for axis in range(2):
                passed[at, axis] = int(np.floor(start[axis] + share * (ends[i, axis] - start[axis])))
            at += 1
    return passed
