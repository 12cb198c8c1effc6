"""Fit of a scan at a pose, and detection of a lost robot."""

import math
from dataclasses import dataclass

import numba
import numpy as np

from amcl_lite.sensor.beams import Beams
from amcl_lite.sensor.likelihood_field import LikelihoodField, fit_at, pose_in_cells
from planar import OccupancyGrid, Pose2
from planar.geometry.ray_casting import cast_rays

# Standard deviation of the distance between a beam's end and the obstacle that explains it [m].
_EXPLAINED_WITHIN = 0.1
# A beam that is longer than expected by this has passed through an obstacle of the map [m].
_THROUGH = 0.25
_TINY = 1e-30  # so that the logarithm of a fit exists
# Logistic regression of "the pose is right to 0.5 m" on 7200 poses of ten drives through map/home.world,
# half of them wrong, with up to 40 % of the beams cut short by objects that are not in the map. Other
# worlds: tests/benchmarks/localization_quality.py (area under the ROC curve 0.998 over three worlds).
_BIAS, _PER_EXPLAINED, _PER_THROUGH = -6.85, 17.2, -9.8

# Smoothed over about this time, seconds, quality must fall below LOST_BELOW for the robot to be lost, and
# rise above FOUND_ABOVE for it to be found again.
SMOOTHING_SECONDS = 1.0
LOST_BELOW, FOUND_ABOVE = 0.2, 0.7
# Probability above which a single scan confirms a pose.
CONFIRMED_ABOVE = 0.99


@dataclass(frozen=True)
class ScanQuality:
    """Fit of one scan at a pose.

    Attributes:
        probability: Probability that the pose is correct to 0.5 m, given this scan alone.
        explained: Mean fit of the beams' ends, 0 to 1.
        through: Share of beams that would have passed through an obstacle.
        mean_distance: Mean distance from the beams' ends to the nearest obstacles [m].
    """

    probability: float
    explained: float
    through: float
    mean_distance: float

    @property
    def contradicts_pose(self) -> bool:
        """Whether the scan contradicts the pose."""
        return self.probability < LOST_BELOW

    @property
    def confirms_pose(self) -> bool:
        """Whether the scan alone confirms the pose."""
        return self.probability > CONFIRMED_ABOVE


def scan_quality(
    base_in_map: Pose2, beams: Beams, field: LikelihoodField, grid: OccupancyGrid
) -> ScanQuality:
    """Evaluate a pose by the beams of a scan; beams without return carry less evidence."""
    laser_in_map = base_in_map @ Pose2(float(beams.start_xy[0]), float(beams.start_xy[1]), 0.0)
    expected = cast_rays(grid, laser_in_map, beams.directions, beams.max_range)
    x, y, yaw = base_in_map.x, base_in_map.y, base_in_map.yaw
    explained, through, mean_distance = _judged(
        x, y, yaw, beams.ends_xy, beams.ranges, expected, field.map_to_cells, field.fit, field.sigma
    )
    looked_at = max(len(beams.ranges) + beams.unmeasured, 1)
    met, through = len(beams.ends_xy) / looked_at, through / looked_at
    evidence = met * (_BIAS + _PER_EXPLAINED * explained) + _PER_THROUGH * through
    return ScanQuality(1.0 / (1.0 + math.exp(-evidence)), explained, through, mean_distance)


@numba.njit(cache=True)
def _judged(x, y, yaw, ends_xy, ranges, expected, map_to_cells, fit, sigma):
    """Return mean fit, number of beams through obstacles, mean distance (inf without any hit)."""
    through = 0
    for i in range(ranges.size):
        through += ranges[i] > expected[i] + _THROUGH
    met = ends_xy.shape[0]
    if met == 0:
        return 0.0, through, np.inf
    col, row, c, s = pose_in_cells(x, y, yaw, map_to_cells)
    explained, distance = 0.0, 0.0
    for i in range(met):
        end_x, end_y = ends_xy[i, 0], ends_xy[i, 1]
        value = fit_at(fit, col + c * end_x - s * end_y, row + s * end_x + c * end_y)
        squared = max(-2.0 * sigma**2 * math.log(max(value, _TINY)), 0.0)
        distance += math.sqrt(squared)
        explained += math.exp(-0.5 * squared / _EXPLAINED_WITHIN**2)
    return explained / met, through, distance / met


class LostDetector:
    """Detects a lost robot from smoothed scan qualities, with hysteresis."""

    def __init__(self, is_lost: bool = False):
        self.is_lost = is_lost
        self._smoothed = 0.0 if is_lost else 1.0
        self._stamp = math.nan

    def add(self, quality: ScanQuality, stamp: float) -> bool:
        """Add the quality of a scan with ``stamp`` [s] and return whether the robot is lost."""
        elapsed = stamp - self._stamp
        self._stamp = stamp
        if elapsed > 0.0:
            share = 1.0 - math.exp(-elapsed / SMOOTHING_SECONDS)
            self._smoothed += share * (quality.probability - self._smoothed)
        if self.is_lost:
            self.is_lost = self._smoothed < FOUND_ABOVE
        else:
            self.is_lost = self._smoothed < LOST_BELOW
        return self.is_lost


# Time within which a scan should fit a correct map [s].
MISMATCH_SECONDS = 8.0


class MapMismatchMonitor:
    """Detects, once, that no scan has fitted the map since the start."""

    def __init__(self) -> None:
        self._is_settled = False
        self._first = math.nan

    def add(self, quality: ScanQuality, stamp: float) -> bool:
        """Add the quality of a scan with ``stamp`` [s] and return whether to warn now."""
        if math.isnan(self._first) or stamp < self._first:
            self._first = stamp
        if quality.probability > FOUND_ABOVE:
            self._is_settled = True
        is_due = not self._is_settled and stamp - self._first > MISMATCH_SECONDS
        self._is_settled = self._is_settled or is_due
        return is_due
