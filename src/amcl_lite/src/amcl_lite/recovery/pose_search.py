"""Search for the pose of a scan near the particles and near the last estimate.

After a step of a metre, amcl's default noise spreads the particles by decimetres and tenths of a radian, and
its likelihood, which adds up beams, hardly narrows them: their mean is then farther from the robot's pose
than scan matching converges. Scan matching from several poses drawn by the motion model, as in the improved
proposal of Grisetti et al. ("Improved techniques for grid mapping with Rao-Blackwellized particle filters",
2007), finds it.
"""

import math
from dataclasses import dataclass
from typing import List, Optional

import numpy as np

from amcl_lite.filter.particles import equally_weighted
from amcl_lite.filter.statistics import mean_and_covariance
from amcl_lite.motion.custom_model import MotionModel
from amcl_lite.recovery.quality import FOUND_ABOVE, ScanQuality, scan_quality
from amcl_lite.sensor.beams import Beams
from amcl_lite.sensor.likelihood_field import LikelihoodField
from amcl_lite.sensor.scan_matching import inverse, match_scan
from amcl_lite.sensor.sensor_model import mean_fits
from planar import OccupancyGrid, Pose2, wrap

# An estimate this far from where odometry leads from the last one leaves the track [m].
_JUMP = 0.5
_DRAWN, _STARTS, _BEAMS_FOR_RANKING = 500, 10, 60
# Size of the bins of starts of scan matching, and the reach of one as standard deviation [m, m, rad].
_BIN = np.array((0.15, 0.15, 0.1))
_START_COVARIANCE = np.diag(_BIN) ** 2
# Standard deviation of a match around the predicted pose if odometry were perfect [m, m, rad].
_MATCH_SPREAD = np.diag((0.05, 0.05, 0.05)) ** 2
# Largest loss of log-probability for being far from the predicted pose: the prediction itself may be wrong.
_MAX_PENALTY = 8.0
_MIN_ODDS = 1e-9


@dataclass(frozen=True)
class LastEstimate:
    """An estimate, from which odometry predicts the next one.

    Attributes:
        odom_in_map: Odometry frame in the map.
        base_in_odom: Odometry pose at the estimate.
    """

    odom_in_map: Pose2
    base_in_odom: Pose2

    def predicted(self, base_in_odom: Pose2) -> Pose2:
        """Return the pose in the map to which odometry leads."""
        return self.odom_in_map @ base_in_odom

    def is_left(self, base_in_map: Pose2, base_in_odom: Pose2) -> bool:
        """Whether a pose is not where odometry leads."""
        return self.predicted(base_in_odom).distance_to(base_in_map) > _JUMP

    def proposals(self, base_in_odom: Pose2, motion: MotionModel, rng: np.random.Generator) -> np.ndarray:
        """Draw poses (N, 3) in the map by the motion model."""
        start = (self.odom_in_map @ self.base_in_odom).as_array()
        return motion.moved(np.tile(start, (_DRAWN, 1)), self.base_in_odom, base_in_odom, rng)


class PoseSearch:
    """Scan matching from several poses in one map.

    Args:
        field: Likelihood field of the map.
        grid: The map.
    """

    def __init__(self, field: LikelihoodField, grid: OccupancyGrid):
        self._field, self._grid = field, grid

    def quality(self, base_in_map: Pose2, beams: Beams) -> ScanQuality:
        """Evaluate the fit of a scan at a pose."""
        return scan_quality(base_in_map, beams, self._field, self._grid)

    def needs_search(
        self, base_in_map: Pose2, base_in_odom: Pose2, beams: Beams, track: Optional[LastEstimate]
    ) -> bool:
        """Whether a pose leaves the track, or the scan does not confirm it."""
        if track is not None and track.is_left(base_in_map, base_in_odom):
            return True
        return not self.quality(base_in_map, beams).confirms_pose

    def best_match(
        self,
        found: Pose2,
        particles: np.ndarray,
        proposals: np.ndarray,
        predicted: Optional[Pose2],
        ends_xy: np.ndarray,
        beams: Beams,
    ) -> Pose2:
        """Search for the most probable pose of a scan.

        Args:
            found: Result of scan matching from the mean of the particles.
            particles: (N, 3), particles of the heaviest cluster.
            proposals: (M, 3), poses distributed as predicted; starts of scan matching too.
            predicted: Most probable of these; None if that is not known.
            ends_xy: (B, 2), ends of all beams in the base frame [m].
            beams: The beams by which a pose is judged.

        Returns:
            ``found`` or the result of scan matching from another pose. One that odometry rules out is
            returned only if the scan fits there: where the map explains no scan well, as outdoors among
            bushes, the prediction is better than the least bad fit elsewhere.
        """
        starts = self._starts(np.vstack((proposals, particles)), ends_xy)
        if predicted is not None:
            starts.insert(0, predicted)
        matches = [found] + [match_scan(pose, _START_COVARIANCE, ends_xy, self._field) for pose in starts]
        mean, covariance = mean_and_covariance(equally_weighted(proposals))
        mean, information = predicted or mean, inverse(covariance + _MATCH_SPREAD)

        best, best_log_odds = predicted or found, -math.inf
        for pose in matches:
            off = pose.as_array() - mean.as_array()
            off[2] = wrap(float(off[2]))
            penalty = 0.5 * float(off @ information @ off)
            probability = self.quality(pose, beams).probability
            if predicted is not None and penalty > _MAX_PENALTY and probability < FOUND_ABOVE:
                continue
            log_odds = _log_odds(probability) - min(penalty, _MAX_PENALTY)
            if log_odds > best_log_odds:
                best, best_log_odds = pose, log_odds
        return best

    def _starts(self, poses: np.ndarray, ends_xy: np.ndarray) -> List[Pose2]:
        """The poses that fit best, one in each bin."""
        few = ends_xy[:: max(1, len(ends_xy) // _BEAMS_FOR_RANKING)]
        sorted_poses = poses[np.argsort(-mean_fits(poses, few, self._field), kind="stable")]
        bins = np.floor(sorted_poses / _BIN).astype(np.int64)
        best_in_bin = np.unique(bins, axis=0, return_index=True)[1]
        return [Pose2.from_array(pose) for pose in sorted_poses[np.sort(best_in_bin)[:_STARTS]]]


def _log_odds(probability: float) -> float:
    limited = min(max(probability, _MIN_ODDS), 1.0 - _MIN_ODDS)
    return math.log(limited / (1.0 - limited))
