"""The front end: follows the robot from scan to scan against a local map of scans whose poses it trusts."""

import math
from collections import deque
from dataclasses import dataclass
from typing import Deque, Optional, Sequence, Tuple

import numpy as np

from planar import Pose2
from slam_lite.config import MapperSettings
from slam_lite.matching.correlative import Window, search_far
from slam_lite.matching.local_map import Match, wide_map
from slam_lite.matching.refinement import refine
from slam_lite.matching.scan_matcher import Prediction, scan_matcher_of
from slam_lite.odometry import Odometry
from slam_lite.surface import Surface
from slam_lite.view import View

# A match with a smaller response than this is searched again in a wide window, as after a slip of the wheels.
_POOR_RESPONSE = 0.4
_WIDE_WINDOW = Window(distance=0.8, angle=0.8)
_SURE_RESPONSE = 0.7
# Known scans are matched to out to this distance, metres, and gathered anew after half of it.
_KNOWN_RADIUS = 10.0
_NO_BELIEF = np.zeros((3, 3))


# Odometry of less than this, metres or radians, counts as standing still; scans err by less than that.
_STILL, _STUCK = 1e-3, 0.03
# Odometry that was off by so much, in units of its variance, may be off by as much again.
_SURPRISING = 25.0
# A match of so many points says more than odometry, and, with this information, of each direction, 1 / m^2.
_SURE_POINTS, _SURE_INFORMATION = 60, 4e3
# Variance of a robot's motion from one scan to the next, if it moves on as it did: (3,), m^2, m^2, rad^2.
_STEADY_MOTION_VARIANCE = np.array([0.1**2, 0.1**2, 0.15**2])


def moves(motion: Pose2, least: float = _STILL) -> bool:
    """Whether a motion is one of at least ``least`` metres or radians."""
    return math.hypot(motion.x, motion.y) >= least or abs(motion.yaw) >= least


@dataclass(frozen=True, eq=False)
class Tracked:
    """One scan followed: ``base_in_track`` drifts, but never jumps.

    ``information``: (3, 3), of the pose relative to the local map, along the track's axes. ``response``:
    share of the scan explained by the local map; ``surprise``: squared deviation of the matched from the
    odometric motion in units of its variance.
    """

    base_in_track: Pose2
    information: np.ndarray
    response: float
    surprise: float


class RecentScans:
    """The local map of the last key scans: grows to ``window_keys``, then leaves out the older half."""

    def __init__(self, window_keys: int):
        self.local_map = wide_map()
        self._window_keys = window_keys
        self._window: Deque[Tuple[Surface, Pose2]] = deque()
        self._last_view: Optional[View] = None

    def add(self, surface: Surface, base_in_track: Pose2) -> None:
        """Adds a key scan."""
        self._last_view = View(surface, base_in_track)
        if len(self._window) >= self._window_keys:
            for _ in range(len(self._window) // 2):
                self._window.popleft()
            self.local_map.clear(base_in_track)
            for old, old_in_track in self._window:
                self.local_map.add(old, old_in_track)
        elif not self._window:
            self.local_map.clear(base_in_track)
        self._window.append((surface, base_in_track))
        self.local_map.add(surface, base_in_track)

    def gather(self, base_in_track: Pose2) -> None:
        """Nothing to do: the scans around the robot are those it has just made."""

    def new_share(self, surface: Surface, base_in_track: Pose2) -> float:
        """Share of a scan, 0 to 1, that looks where the last key scan did not."""
        return 0.0 if self._last_view is None else self._last_view.new_share(surface, base_in_track)


class KnownScans:
    """The local map of a finished map's scans around the robot; the track frame is the map frame."""

    def __init__(self, surfaces: Sequence[Surface], poses: np.ndarray):
        self.local_map = wide_map()
        self._surfaces, self._poses = surfaces, poses
        self._center: Optional[Pose2] = None

    def gather(self, base_in_track: Pose2) -> None:
        """Takes the scans around the robot, if it has left the middle of those taken last."""
        if self._center is not None and self._center.distance_to(base_in_track) < 0.5 * _KNOWN_RADIUS:
            return
        self._center = base_in_track
        self.local_map.clear(base_in_track)
        distances = np.hypot(self._poses[:, 0] - base_in_track.x, self._poses[:, 1] - base_in_track.y)
        for key in np.flatnonzero(distances < _KNOWN_RADIUS):
            self.local_map.add(self._surfaces[key], Pose2.from_array(self._poses[key]))

    def new_share(self, surface: Surface, base_in_track: Pose2) -> float:
        """A finished map has nothing new."""
        return 0.0


class FrontEnd:
    """Matches scans to a local map, with odometry as prediction and prior.

    ``odometry_is_stuck``: odometry stands still while the scans move; then the robot is predicted to move on
    as it did.
    """

    def __init__(self, settings: MapperSettings, scans, base_in_track: Optional[Pose2] = None):
        """``scans``: RecentScans or KnownScans. ``base_in_track``: at the start; default: as in odometry.

        Raises MatchingError if a matcher of somebody's own cannot be made.
        """
        self._settings = settings
        self._matcher = scan_matcher_of(settings)
        self._scans = scans
        self._odometry = Odometry(settings)
        self._last_in_odom: Optional[Pose2] = None
        self._last_in_track = base_in_track
        self._matched_motion = Pose2()
        self._last_error: np.ndarray = np.zeros(3)
        self._found_again: Optional[Pose2] = None
        self.odometry_is_stuck = False

    def track(self, base_in_odom: Pose2, surface: Surface) -> Tracked:
        """Follows one scan, taken where odometry believed ``base_in_odom``.

        Raises MatchingError, and is as it was then, for what goes wrong in a matcher of somebody's own.
        """
        last_in_track = base_in_odom if self._last_in_track is None else self._last_in_track
        motion = Pose2() if self._last_in_odom is None else self._last_in_odom.inverse() @ base_in_odom
        mended, variance = self._odometry.mended(motion), self._odometry.variance(motion) + self._last_error
        if self._found_again is not None:
            match = self._match(surface, self._found_again, Pose2(), _STEADY_MOTION_VARIANCE)
            self._found_again = None
        elif self.odometry_is_stuck and not moves(motion):
            match = self._match(surface, last_in_track, self._matched_motion, _STEADY_MOTION_VARIANCE)
        else:
            match = self._match(surface, last_in_track, mended, variance)
        self._matched_motion = last_in_track.inverse() @ match.base_pose
        deviation = (motion.inverse() @ self._matched_motion).as_array()
        believed = self._odometry.believed_variance(motion)
        surprise = float(np.sum(deviation**2 / believed))
        is_sure, information = match.response * len(surface) > _SURE_POINTS, match.information
        self._last_error = deviation**2 if is_sure and surprise > _SURPRISING else np.zeros(3)
        if not is_sure:  # the wheels may have slipped unseen
            information = np.diag(1.0 / believed)
        elif moves(motion) and np.diag(information).min() > _SURE_INFORMATION:
            self._odometry.learn(motion, self._matched_motion)
        self.odometry_is_stuck = not moves(motion) and moves(self._matched_motion, _STUCK)
        self._last_in_odom, self._last_in_track = base_in_odom, match.base_pose
        return Tracked(match.base_pose, information, match.response, surprise)

    def finds_again(self, surface: Surface) -> bool:
        """Whether a scan shows that the robot is still where it was; it is tracked from there then."""
        last_in_track = self._last_in_track
        if last_in_track is None or self._scans.local_map.is_empty:
            return False
        unknown = Match(last_in_track, _NO_BELIEF, 0.0)
        match = self._search_wide(surface, (last_in_track,), unknown)
        if match is unknown:
            return False
        self._found_again = match.base_pose
        return True

    def _match(self, surface: Surface, last_in_track: Pose2, motion: Pose2, variance: np.ndarray) -> Match:
        predicted = last_in_track @ motion
        self._scans.gather(predicted)
        local_map = self._scans.local_map
        doubt = variance if moves(motion) else _STEADY_MOTION_VARIANCE
        new_share = self._scans.new_share(surface, predicted)
        prediction = Prediction(predicted, variance, doubt, new_share)
        if local_map.is_empty:
            return Match(predicted, prediction.information, 1.0)
        match = self._matcher.match(surface, local_map, prediction)
        if match.response < _POOR_RESPONSE and len(surface) > _SURE_POINTS:
            match = self._search_wide(surface, (predicted, last_in_track), match)
        if match.response < self._settings.min_response:
            return Match(predicted, prediction.information, match.response)
        return match

    def _search_wide(self, surface: Surface, centers: Tuple[Pose2, ...], match: Match) -> Match:
        """A good and only match around one of ``centers``, if there is one; else ``match``.

        What is seen for the first time matches poorly too, and must not be taken for something else.
        """
        local_map = self._scans.local_map
        for center in centers:
            peak = search_far(surface, local_map, center, _WIDE_WINDOW, _SURE_RESPONSE - 0.1, apart=0.5)
            if peak is not None and peak.is_unique and not peak.slide.any():
                wide = refine(surface, local_map, peak.base_pose, peak.base_pose, _NO_BELIEF)
                if wide.response > _SURE_RESPONSE:
                    return wide
        return match
