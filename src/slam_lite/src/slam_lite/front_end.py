"""The front end: follows the robot from scan to scan against a window of its recent key scans."""

import math
from collections import deque
from dataclasses import dataclass
from typing import Deque, Optional, Tuple

import numpy as np

from planar import Pose2
from slam_lite.config import MapperSettings
from slam_lite.matching.correlative import Window, search_far, search_near
from slam_lite.matching.local_map import LocalMap, Match
from slam_lite.matching.refinement import refine
from slam_lite.surface import Surface

# A match with a smaller response than this is searched again in a wide window, as after a slip of the wheels.
_POOR_RESPONSE = 0.4
_WIDE_WINDOW = Window(distance=0.8, angle=0.8)


@dataclass(frozen=True, eq=False)
class Tracked:
    """One scan followed: ``base_in_track`` drifts, but never jumps.

    ``information``: (3, 3), of the pose relative to the recent scans, along the track's axes.
    ``response``: share of the scan explained by the recent scans; ``surprise``: squared deviation of the
    matched from the odometric motion in units of its variance. ``is_key``: the scan joined the window.
    """

    base_in_track: Pose2
    information: np.ndarray
    response: float
    surprise: float
    is_key: bool


class FrontEnd:
    """Scan matching against the last key scans, with odometry as prediction and prior.

    The track frame is the odometry frame at the first scan. The window grows to ``window_keys`` key scans;
    then the older half is left out.
    """

    def __init__(self, settings: MapperSettings):
        self._settings = settings
        self._local_map = LocalMap()
        self._window: Deque[Tuple[Surface, Pose2]] = deque()
        self._last_in_odom: Optional[Pose2] = None
        self._last_in_track = Pose2()

    def track(self, base_in_odom: Pose2, surface: Surface) -> Tracked:
        """Follows one scan, taken where odometry believed ``base_in_odom``."""
        if self._last_in_odom is None:
            self._last_in_odom, self._last_in_track = base_in_odom, base_in_odom
            self._add_key(surface, base_in_odom)
            return Tracked(base_in_odom, np.zeros((3, 3)), 1.0, 0.0, True)
        motion = self._last_in_odom.inverse() @ base_in_odom
        variance = self._motion_variance(motion)
        match = self._match(surface, motion, variance)
        matched_motion = self._last_in_track.inverse() @ match.base_pose
        deviation = (motion.inverse() @ matched_motion).as_array()
        self._last_in_odom, self._last_in_track = base_in_odom, match.base_pose
        is_key = self._is_key(match.base_pose)
        if is_key:
            self._add_key(surface, match.base_pose)
        surprise = float(np.sum(deviation**2 / variance))
        return Tracked(match.base_pose, match.information, match.response, surprise, is_key)

    def _match(self, surface: Surface, motion: Pose2, variance: np.ndarray) -> Match:
        prior = np.diag(1.0 / variance)
        predicted = self._last_in_track @ motion
        window = Window(
            float(np.clip(3.0 * math.sqrt(variance[0]), 0.1, 0.4)),
            float(np.clip(3.0 * math.sqrt(variance[2]), 0.1, 0.5)),
        )
        start = search_near(surface, self._local_map, predicted, window)
        match = refine(surface, self._local_map, start, predicted, prior)
        if match.response < _POOR_RESPONSE:
            match = self._search_wide(surface, predicted, match)
        if match.response < self._settings.min_response:
            return Match(predicted, prior, match.response)
        return match

    def _search_wide(self, surface: Surface, predicted: Pose2, match: Match) -> Match:
        """A clearly better match than ``match`` around the prediction or the last pose, if there is one."""
        for center in (predicted, self._last_in_track):
            peak = search_far(surface, self._local_map, center, _WIDE_WINDOW, _POOR_RESPONSE, apart=0.5)
            if peak is not None:
                wide = refine(surface, self._local_map, peak.base_pose, peak.base_pose, np.zeros((3, 3)))
                if wide.response > match.response + 0.2:
                    match = wide
        return match

    def _motion_variance(self, motion: Pose2) -> np.ndarray:
        """Variances (3,) of odometry over a motion, growing linearly with it as those of a random walk do."""
        settings = self._settings
        distance, turn = math.hypot(motion.x, motion.y), abs(motion.yaw)
        xy = settings.odom_xy_per_distance**2 * distance + settings.odom_xy_per_turn**2 * turn
        yaw = settings.odom_yaw_per_distance**2 * distance + settings.odom_yaw_per_turn**2 * turn
        return np.array([xy + 0.005**2, xy + 0.005**2, yaw + 0.005**2])

    def _is_key(self, base_in_track: Pose2) -> bool:
        moved = self._window[-1][1].inverse() @ base_in_track
        far = math.hypot(moved.x, moved.y) >= self._settings.key_distance
        return far or abs(moved.yaw) >= self._settings.key_angle

    def _add_key(self, surface: Surface, base_in_track: Pose2) -> None:
        if len(self._window) >= self._settings.window_keys:
            for _ in range(len(self._window) // 2):
                self._window.popleft()
            self._local_map.clear(base_in_track)
            for old, old_in_track in self._window:
                self._local_map.add(old, old_in_track)
        elif not self._window:
            self._local_map.clear(base_in_track)
        self._window.append((surface, base_in_track))
        self._local_map.add(surface, base_in_track)
