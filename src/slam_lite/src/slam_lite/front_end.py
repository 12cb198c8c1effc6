"""The front end: tracks the robot from scan to scan by matching each scan to a local map of keyframes."""

from collections import deque
from dataclasses import dataclass
from typing import Deque, Optional, Protocol, Sequence, Tuple

import numpy as np

from planar import Pose2
from slam_lite.angular_coverage import AngularCoverage
from slam_lite.config import MapperSettings
from slam_lite.matching.correlative import SearchWindow, search_branch_and_bound
from slam_lite.matching.local_map import LocalMap, Match, long_range_map
from slam_lite.matching.refinement import refine
from slam_lite.matching.scan_matcher import Prediction, scan_matcher_of
from slam_lite.odometry.checks import has_moved
from slam_lite.odometry.error_model import OdometryErrorModel
from slam_lite.point_cloud import PointCloud

# A match with a lower response is searched again in a wide window, as after a wheel slip.
_POOR_RESPONSE = 0.4
_WIDE_WINDOW = SearchWindow(distance=0.8, angle=0.8)
# Response of a match in the wide window that is accepted.
_GOOD_RESPONSE = 0.7
# Radius around the robot within which keyframes of a finished map are matched to [m]; they are collected
# again after half of it.
_NEARBY_RADIUS = 10.0
_NO_PRIOR = np.zeros((3, 3))
# Matched motion, metres or radians, above which odometry that reports no motion is stuck.
_STUCK_MOTION = 0.03
# Squared error of odometry, in units of its variance, above which the next error may be as large.
_SLIP_CHI_SQUARE = 25.0
# Number of matching points above which a match is reliable, and least information [1 / m^2] in each direction
# for the error model to learn from it.
_MIN_POINTS, _MIN_INFORMATION = 60, 4e3
# Variance (3,) [m^2, m^2, rad^2] of the motion between two scans if it is predicted to continue as before.
_STEADY_MOTION_VARIANCE = np.array([0.1**2, 0.1**2, 0.15**2])


@dataclass(frozen=True, eq=False)
class TrackedPose:
    """Pose of a scan in the track frame, which drifts but never jumps.

    Attributes:
        base_in_track: Pose of the base.
        information: (3, 3), of the pose relative to the local map, along the axes of the track frame, 1 / (m,
            m, rad)^2.
        response: Fraction of the scan that matches the local map, 0 to 1.
        odometry_chi_square: Squared difference between matched and odometric motion, in units of its
            variance.
    """

    base_in_track: Pose2
    information: np.ndarray
    response: float
    odometry_chi_square: float


class KeyframeWindow(Protocol):
    """Keyframes that scans are matched to.

    Attributes:
        local_map: Points of these keyframes, in the track frame.
    """

    local_map: LocalMap

    def update_around(self, base_in_track: Pose2) -> None:
        """Load the keyframes around a pose into ``local_map``.

        Args:
            base_in_track: Predicted pose of the base at the next scan.
        """

    def unseen_fraction(self, cloud: PointCloud, base_in_track: Pose2) -> float:
        """Compute which fraction of a scan lies in directions that the map never covered.

        Args:
            cloud: Points of the scan, in the base frame.
            base_in_track: Pose of the base at the scan.

        Returns:
            Fraction of the points, 0 to 1.
        """
        ...


class RecentKeyframes:
    """Local map of the most recent keyframes, for mapping.

    When it holds ``window_keyframes`` keyframes, the older half is removed.
    """

    def __init__(self, window_keyframes: int, is_coarse_searched: bool = True):
        """Create an empty window.

        Args:
            window_keyframes: Largest number of keyframes in the window.
            is_coarse_searched: Whether the matcher searches the coarse map alone (see ``LocalMap.add``).
        """
        self.local_map = long_range_map()
        self._is_coarse_searched = is_coarse_searched
        self._window_keyframes = window_keyframes
        self._window: Deque[Tuple[PointCloud, Pose2]] = deque()
        self._last_coverage: Optional[AngularCoverage] = None

    def add(self, cloud: PointCloud, base_in_track: Pose2) -> None:
        """Add a keyframe.

        Args:
            cloud: Points of the keyframe, in the base frame.
            base_in_track: Pose of the keyframe in the track frame.
        """
        self._last_coverage = AngularCoverage(cloud, base_in_track)
        if len(self._window) >= self._window_keyframes:
            for _ in range(len(self._window) // 2):
                self._window.popleft()
            self.local_map.clear(base_in_track)
            for old, old_in_track in self._window:
                self.local_map.add(old, old_in_track, self._is_coarse_searched)
        elif not self._window:
            self.local_map.clear(base_in_track)
        self._window.append((cloud, base_in_track))
        self.local_map.add(cloud, base_in_track, self._is_coarse_searched)

    def update_around(self, base_in_track: Pose2) -> None:
        """Do nothing: the keyframes around the robot are the last ones."""

    def unseen_fraction(self, cloud: PointCloud, base_in_track: Pose2) -> float:
        """Compute the fraction of a scan, 0 to 1, in directions that the last keyframe does not cover."""
        return (
            0.0 if self._last_coverage is None else self._last_coverage.unseen_fraction(cloud, base_in_track)
        )


class NearbyKeyframes:
    """Local map of the keyframes around the robot in a finished map; the track frame is the map frame."""

    def __init__(self, clouds: Sequence[PointCloud], poses: np.ndarray):
        """Set the finished map.

        Args:
            clouds: Points of all keyframes, each in its base frame.
            poses: (N, 3), poses of all keyframes in the map frame.
        """
        self.local_map = long_range_map()
        self._clouds, self._poses = clouds, poses
        self._center: Optional[Pose2] = None

    def update_around(self, base_in_track: Pose2) -> None:
        """Reload the keyframes around the robot once it has left the middle of the loaded area."""
        if self._center is not None and self._center.distance_to(base_in_track) < 0.5 * _NEARBY_RADIUS:
            return
        self._center = base_in_track
        self.local_map.clear(base_in_track)
        distances = np.hypot(self._poses[:, 0] - base_in_track.x, self._poses[:, 1] - base_in_track.y)
        for i in np.flatnonzero(distances < _NEARBY_RADIUS):
            self.local_map.add(self._clouds[i], Pose2.from_array(self._poses[i]))

    def unseen_fraction(self, cloud: PointCloud, base_in_track: Pose2) -> float:
        """Return 0: a finished map covers all directions."""
        return 0.0


class FrontEnd:
    """Scan-to-map tracking, with odometry as prediction and prior.

    Attributes:
        odometry_is_stuck: Whether odometry stands still while the scans move; the motion is then predicted to
            continue as before.
    """

    def __init__(
        self, settings: MapperSettings, keyframes: KeyframeWindow, base_in_track: Optional[Pose2] = None
    ):
        """Create the scan matcher.

        Args:
            settings: Settings of the matcher and of the odometry error model.
            keyframes: Keyframes that scans are matched to.
            base_in_track: Pose of the base at the first scan; by default the odometry pose.

        Raises:
            MatchingError: If a custom matcher cannot be created.
        """
        self._settings = settings
        self._matcher = scan_matcher_of(settings)
        self._keyframes = keyframes
        self._odometry = OdometryErrorModel(settings)
        self._last_in_odom: Optional[Pose2] = None
        self._last_in_track = base_in_track
        self._matched_motion = Pose2()
        self._last_error: np.ndarray = np.zeros(3)
        self._relocalized: Optional[Pose2] = None
        self.odometry_is_stuck = False

    def track(self, base_in_odom: Pose2, cloud: PointCloud) -> TrackedPose:
        """Match one scan.

        Args:
            base_in_odom: Odometry pose of the base at the scan.
            cloud: Points of the scan, in the base frame.

        Returns:
            Pose of the base in the track frame.

        Raises:
            MatchingError: If a custom matcher fails; the front end is unchanged then.
        """
        last_in_track = base_in_odom if self._last_in_track is None else self._last_in_track
        motion = Pose2() if self._last_in_odom is None else self._last_in_odom.inverse() @ base_in_odom
        corrected = self._odometry.corrected(motion)
        variance = self._odometry.variance(motion) + self._last_error
        if self._relocalized is not None:
            match = self._match(cloud, self._relocalized, Pose2(), _STEADY_MOTION_VARIANCE)
            self._relocalized = None
        elif self.odometry_is_stuck and not has_moved(motion):
            match = self._match(cloud, last_in_track, self._matched_motion, _STEADY_MOTION_VARIANCE)
        else:
            match = self._match(cloud, last_in_track, corrected, variance)
        self._matched_motion = last_in_track.inverse() @ match.base_pose
        error = (motion.inverse() @ self._matched_motion).as_array()
        nominal = self._odometry.nominal_variance(motion)
        chi_square = float(np.sum(error**2 / nominal))
        is_reliable, information = match.response * len(cloud) > _MIN_POINTS, match.information
        self._last_error = error**2 if is_reliable and chi_square > _SLIP_CHI_SQUARE else np.zeros(3)
        if not is_reliable:  # the wheels may have slipped without the scans showing it
            information = np.diag(1.0 / nominal)
        elif has_moved(motion) and np.diag(information).min() > _MIN_INFORMATION:
            self._odometry.learn(motion, self._matched_motion)
        self.odometry_is_stuck = not has_moved(motion) and has_moved(self._matched_motion, _STUCK_MOTION)
        self._last_in_odom, self._last_in_track = base_in_odom, match.base_pose
        return TrackedPose(match.base_pose, information, match.response, chi_square)

    def relocalize(self, cloud: PointCloud) -> bool:
        """Check whether a scan matches where the robot was last, and continue tracking from there if so.

        Args:
            cloud: Points of the scan, in the base frame.

        Returns:
            Whether it matches.
        """
        last_in_track = self._last_in_track
        if last_in_track is None or self._keyframes.local_map.is_empty:
            return False
        unknown = Match(last_in_track, _NO_PRIOR, 0.0)
        match = self._search_wide(cloud, (last_in_track,), unknown)
        if match is unknown:
            return False
        self._relocalized = match.base_pose
        return True

    def _match(self, cloud: PointCloud, last_in_track: Pose2, motion: Pose2, variance: np.ndarray) -> Match:
        predicted = last_in_track @ motion
        self._keyframes.update_around(predicted)
        local_map = self._keyframes.local_map
        search_variance = variance if has_moved(motion) else _STEADY_MOTION_VARIANCE
        unseen_fraction = self._keyframes.unseen_fraction(cloud, predicted)
        prediction = Prediction(predicted, variance, search_variance, unseen_fraction)
        if local_map.is_empty:
            return Match(predicted, prediction.information, 1.0)
        match = self._matcher.match(cloud, local_map, prediction)
        if match.response < _POOR_RESPONSE and len(cloud) > _MIN_POINTS:
            match = self._search_wide(cloud, (predicted, last_in_track), match)
        if match.response < self._settings.min_response:
            return Match(predicted, prediction.information, match.response)
        return match

    def _search_wide(self, cloud: PointCloud, centers: Tuple[Pose2, ...], fallback: Match) -> Match:
        """Return a good and unique match around one of ``centers``, else ``fallback``.

        Areas seen for the first time match poorly too, and must not be matched to something else.
        """
        local_map = self._keyframes.local_map
        min_score = _GOOD_RESPONSE - 0.1
        for center in centers:
            peak = search_branch_and_bound(cloud, local_map, center, _WIDE_WINDOW, min_score, apart=0.5)
            if peak is not None and peak.is_unique and not peak.degenerate_direction.any():
                wide = refine(cloud, local_map, peak.base_pose, peak.base_pose, _NO_PRIOR)
                if wide.response > _GOOD_RESPONSE:
                    return wide
        return fallback
