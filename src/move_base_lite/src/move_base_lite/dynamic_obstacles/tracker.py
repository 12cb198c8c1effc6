"""Tracking of dynamic obstacles: scan segments in formerly free space, tracked at constant velocity."""

import math
from collections import deque
from dataclasses import replace
from typing import Deque, Dict, List, NamedTuple, Optional, Sequence, Set

import numpy as np
from numpy.typing import NDArray

from move_base_lite.costmap import Observation
from move_base_lite.dynamic_obstacles.scan_segments import (
    MIN_SEGMENT_BEAMS,
    ScanSegment,
    ScanSnapshot,
    hidden_segment,
    segments_of,
)
from move_base_lite.dynamic_obstacles.track import MIN_FREE_SHARE, MIN_TRAVEL_SPEED, MOVING_MEMORY, Track
from planar import Pose2
from planar.deprecation import renamed_method

# Age of the scan that segments are compared with [s], and its least age, below which nothing can be detected.
REFERENCE_AGE, MIN_REFERENCE_AGE = 1.0, 0.3
# Time without a matching segment after which a track is dropped [s]: where the scan shows its place free, and
# where the place is occluded or out of view.
MAX_VISIBLE_AGE, MAX_OCCLUDED_AGE = 0.3, 2.5
# Time without a matching segment after which a track matches newly appeared segments only [s].
MAX_MATCH_AGE = 0.3
# Age of the scan in which a newly appeared segment must be missing [s].
APPEARANCE_AGE = 0.15
# Distance from a track's predicted outline within which points of a wide segment may belong to it [m].
OUTLINE_MARGIN = 0.2
# An empty result of DynamicObstacleTracker.obstacles_at.
NO_DYNAMIC_OBSTACLES = np.empty((0, 5))


class TrackerSettings(NamedTuple):
    """Settings of the tracker.

    Attributes:
        max_range: Range within which obstacles are tracked [m].
        track_appearing: Whether objects that come into view from behind others are tracked too.
    """

    max_range: float = 4.0
    track_appearing: bool = False


class DynamicObstacleTracker:
    """Detects and tracks moving objects in laser scans.

    It works in the odom frame, in which poses do not jump.
    """

    def __init__(self) -> None:
        self._past: Deque[ScanSnapshot] = deque()
        self._tracks: List[Track] = []

    def update(
        self, base_in_odom: Pose2, observation: Observation, settings: TrackerSettings = TrackerSettings()
    ) -> Observation:
        """Process a scan; one that is older than the last one resets the tracker.

        Args:
            base_in_odom: Robot pose at the time of the scan.
            observation: The scan.
            settings: Settings of the tracker.

        Returns:
            The scan without its moving beams: NaN where a beam ends on an object that has moved lately.
        """
        if self._past and observation.stamp < self._past[-1].stamp:
            self._past.clear()
            self._tracks.clear()
        snapshot = ScanSnapshot(base_in_odom @ observation.sensor_in_base, observation, settings.max_range)
        snapshot.segments = segments_of(snapshot)
        for track in self._tracks:
            track.predict(snapshot.stamp)
        snapshot.segments = self._split_merged(snapshot.segments)
        self._associate(snapshot, settings.track_appearing)
        self._tracks = [
            track
            for track in self._tracks
            if track.is_alive(snapshot, MAX_VISIBLE_AGE, MAX_OCCLUDED_AGE) and not track.is_static
        ]
        self._past.append(snapshot)
        return replace(observation, ranges=self._without_moving_beams(snapshot, observation.ranges))

    def obstacles_at(self, now: float) -> NDArray[np.float64]:
        """Predict the dynamic obstacles.

        Args:
            now: Time of the prediction [s].

        Returns:
            Rows (N, 5) of x, y, vx, vy, radius in the odom frame [m, m/s].
        """
        moving = [track.state_at(now) for track in self._tracks if track.is_dynamic]
        return np.array(moving) if moving else NO_DYNAMIC_OBSTACLES

    look = renamed_method("look", "update")
    at = renamed_method("at", "obstacles_at")

    def _associate(self, snapshot: ScanSnapshot, track_appearing: bool) -> None:
        """Correct tracks with the segments that match them, and start tracks for the other segments."""
        reference = self._reference_snapshot(snapshot.stamp)
        recent = self._snapshot_at(snapshot.stamp - MIN_REFERENCE_AGE)
        last = self._snapshot_at(snapshot.stamp - APPEARANCE_AGE)
        is_checked = track_appearing or bool(self._tracks)
        was_free = [_was_free(segment, reference) for segment in snapshot.segments]
        is_new = [
            is_free or (is_checked and _has_appeared(segment, snapshot.stamp, last))
            for segment, is_free in zip(snapshot.segments, was_free)
        ]
        matches = self._matches(snapshot, is_new)
        for i, segment in enumerate(snapshot.segments):
            if i in matches:
                track = matches[i]
                is_free = was_free[i] or _was_free(segment, recent) or track.has_left_its_place(snapshot)
                track.correct(segment, was_free[i], is_free)
            elif was_free[i] or (is_new[i] and track_appearing):
                self._tracks.append(Track(segment, snapshot.stamp))

    def _split_merged(self, segments: List[ScanSegment]) -> List[ScanSegment]:
        """Split segments of several objects among the tracks whose predicted outlines are near."""
        parts: List[ScanSegment] = []
        for segment in segments:
            tracks = [track for track in self._tracks if track.is_narrower_than(segment)]
            is_merged = any(track.is_radius_known for track in tracks)
            parts += _parts(segment, tracks) if is_merged else [segment]
        return parts

    def _matches(self, snapshot: ScanSnapshot, is_new: Sequence[bool]) -> Dict[int, Track]:
        """Tracks by the index of their segment: the nearest pairs first, each track and segment once."""
        pairs = []
        for i, segment in enumerate(snapshot.segments):
            seen_since = -math.inf if is_new[i] else snapshot.stamp - MAX_MATCH_AGE
            for j, track in enumerate(self._tracks):
                if track.can_match(segment, seen_since):
                    pairs.append((track.distance_to(segment), i, j))
        matches: Dict[int, Track] = {}
        taken: Set[int] = set()
        for _, i, j in sorted(pairs):
            if i not in matches and j not in taken:
                matches[i] = self._tracks[j]
                taken.add(j)
        return matches

    def _without_moving_beams(self, snapshot: ScanSnapshot, ranges: np.ndarray) -> np.ndarray:
        """The ranges (N,), NaN where a beam ends on an object that has moved lately."""
        static = np.array(ranges)
        for track in self._tracks:
            if snapshot.stamp - track.moved_at <= MOVING_MEMORY:
                static[snapshot.beams[track.covers(snapshot.points_xy)]] = np.nan
        return static

    def _reference_snapshot(self, stamp: float) -> Optional[ScanSnapshot]:
        """The snapshot that defines what was free, about REFERENCE_AGE old; None if all are too new."""
        while len(self._past) > 1 and stamp - self._past[1].stamp >= REFERENCE_AGE:
            self._past.popleft()
        is_old_enough = self._past and stamp - self._past[0].stamp >= MIN_REFERENCE_AGE
        return self._past[0] if is_old_enough else None

    def _snapshot_at(self, stamp: float) -> Optional[ScanSnapshot]:
        """The newest snapshot that is not newer than ``stamp``."""
        return next((snapshot for snapshot in reversed(self._past) if snapshot.stamp <= stamp), None)


def _was_free(segment: ScanSegment, before: Optional[ScanSnapshot]) -> bool:
    """Whether the segment lies in what was free space in an earlier snapshot."""
    return before is not None and before.free_share(segment.points_xy) >= MIN_FREE_SHARE


def _parts(segment: ScanSegment, tracks: List[Track]) -> List[ScanSegment]:
    """Split a segment into the points nearest to each track's outline, and the others."""
    distances = np.array([track.boundary_distance(segment.points_xy) for track in tracks])
    owner = np.where(distances.min(axis=0) < OUTLINE_MARGIN, distances.argmin(axis=0), len(tracks))
    groups = [segment.points_xy[owner == i] for i in range(len(tracks) + 1)]
    groups = [group for group in groups if len(group) >= MIN_SEGMENT_BEAMS]
    if len(groups) < 2:
        return [segment]
    return [hidden_segment(group) for group in groups]


def _has_appeared(segment: ScanSegment, stamp: float, before: Optional[ScanSnapshot]) -> bool:
    """Whether no earlier segment was near: the apparent motion of static objects is slower."""
    if before is None:
        return False
    distance = MIN_TRAVEL_SPEED * (stamp - before.stamp)
    return all(math.dist(segment.centre_xy, other.centre_xy) > distance for other in before.segments)
