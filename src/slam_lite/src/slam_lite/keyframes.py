"""Keyframe selection: which scans are chosen as keyframes, and which keyframes later sessions make redundant.

A keyframe of an older session is redundant if newer keyframes cover nearly all that it saw often enough,
whether the obstacles are still there or not. So a map grows with the area seen, not with the number of
visits.
"""

import math
from typing import Optional, Sequence, Tuple

import numba
import numpy as np

from planar import Pose2
from slam_lite.config import MapperSettings
from slam_lite.graph.sparsification import sparsify
from slam_lite.rendering import ScanBeams
from slam_lite.state import MapState

# Cell size of the coverage grid [m], and scans after which a cell counts as covered.
_CELL, _COVERED_COUNT = 0.2, 6
# Share of a keyframe's cells that are not covered otherwise, below which it is redundant.
_MIN_NEEDED_SHARE = 0.15
# Empty cells around the lasers and the ends of their beams.
_MARGIN = 3


def is_keyframe(base_in_last_keyframe: Optional[Pose2], settings: MapperSettings) -> bool:
    """Choose keyframes: the first scan, and each scan after enough motion or rotation.

    Args:
        base_in_last_keyframe: Pose of the base in the last keyframe; None if there is none yet.
        settings: Thresholds ``keyframe_distance`` [m] and ``keyframe_angle`` [rad].
    """
    if base_in_last_keyframe is None:
        return True
    moved = base_in_last_keyframe
    is_far = math.hypot(moved.x, moved.y) >= settings.keyframe_distance
    return is_far or abs(moved.yaw) >= settings.keyframe_angle


def prune_keyframes(state: MapState) -> MapState:
    """Remove the redundant keyframes of older sessions.

    Args:
        state: State with the keyframes of all sessions.

    Returns:
        State with the other keyframes, between which edges keep the information of the removed ones.
    """
    if len(state.poses) == 0 or (state.sessions == state.sessions[-1]).all():
        return state
    kept = np.flatnonzero(_is_needed(state.beams, state.poses, state.sessions == state.sessions[-1]))
    return MapState(
        [state.clouds[i] for i in kept],
        [state.beams[i] for i in kept],
        state.poses[kept],
        sparsify(state.poses, state.edges, kept),
        state.base_in_map,
        state.sessions[kept],
    )


def _is_needed(beams: Sequence[ScanBeams], poses: np.ndarray, is_newest: np.ndarray) -> np.ndarray:
    """Which keyframes (N,) are of the newest session, or cover enough cells that few newer ones cover."""
    extents = [np.vstack(_in_cells(*scan)) for scan in zip(beams, poses) if len(scan[0].marks)]
    if not extents:
        return is_newest
    corner = np.floor(np.min([ends.min(axis=0) for ends in extents], axis=0)).astype(np.int64) - _MARGIN
    end = np.floor(np.max([ends.max(axis=0) for ends in extents], axis=0)).astype(np.int64) + _MARGIN
    counts = np.zeros(end - corner, dtype=np.uint8)
    is_needed = is_newest.copy()
    newest_first = np.concatenate((np.flatnonzero(is_newest), np.flatnonzero(~is_newest)[::-1]))
    for i in newest_first:
        if len(beams[i].marks) == 0:
            continue
        col, row = (np.unique(_traversed_cells(*_in_cells(beams[i], poses[i])), axis=0) - corner).T
        seen = counts[col, row]
        if is_newest[i] or np.mean(seen < _COVERED_COUNT) > _MIN_NEEDED_SHARE:
            is_needed[i] = True
            counts[col, row] = np.minimum(seen, 254) + 1
    return is_needed


def _in_cells(beams: ScanBeams, pose: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Start (2,) and ends (N, 2) of a scan's beams, in cells."""
    in_map = Pose2.from_array(pose)
    start, ends = in_map.transform_points(beams.laser_xy[None])[0], in_map.transform_points(beams.ends_xy)
    return start / _CELL, ends / _CELL


@numba.njit(cache=True, nogil=True)
def _traversed_cells(start, ends):
    """The cells (M, 2) that beams from ``start`` to ``ends``, in cells, traverse in steps of one cell."""
    count = 0
    for i in range(len(ends)):
        count += int(np.hypot(ends[i, 0] - start[0], ends[i, 1] - start[1])) + 1
    cells = np.empty((count, 2), dtype=np.int64)
    at = 0
    for i in range(len(ends)):
        steps = int(np.hypot(ends[i, 0] - start[0], ends[i, 1] - start[1]))
        for step in range(1, steps + 2):
            share = min(1.0, step / max(steps, 1))
            for axis in range(2):
                cells[at, axis] = int(np.floor(start[axis] + share * (ends[i, axis] - start[axis])))
            at += 1
    return cells
