"""Detects sensors that fail while they still publish, by comparing scans, odometry and commands."""

import math
from dataclasses import dataclass
from typing import Optional

import numpy as np

from move_base_lite.plausibility.wheel_monitor import WheelMonitor
from planar import Pose2, Twist2

# Fraction of a scan's beams that is not invalid by chance.
NEARLY_ALL = 0.95
# A scan with this fraction of returns is not followed by one without returns until the robot has moved so far
# [m].
ENOUGH_RETURNS = 0.5
NEAR = 0.3
# Field of view [rad] from which on a sensor always has returns in a room. A depth camera has none close to a
# wall or in open space; turned by this fraction of its field of view, it sees something else.
WIDE_FIELD_OF_VIEW = math.radians(120.0)
SAME_VIEW_FRACTION = 0.25
# Motion, metres or radians, in which noise must change a scan: in total, in how many scans, and least per
# scan.
FROZEN_MOTION, FROZEN_SCANS, MIN_SCAN_MOTION = 0.15, 3, 0.005
# Seconds of a command, and its speed in m/s or rad/s, after which odometry must have changed.
ODOMETRY_PATIENCE = 1.0
MIN_COMMAND = 0.1
# Longest time without such a command [s] after which the robot still counts as commanded: a turn towards a
# goal that odometry never reaches alternates between fast and slow commands.
COMMAND_GAP = 0.5
# Median change of the ranges that proves motion [m].
CHANGED_RANGE = 0.1
# Seconds without odometry after it has been received. Missing scans are covered by expected_update_rate.
ODOMETRY_TIMEOUT = 2.0


@dataclass(frozen=True)
class _ReferenceScan:
    """A scan with enough returns.

    Attributes:
        base: Robot pose in the odometry frame at the scan.
        max_distance: Distance the robot can move before the returns may be out of range [m].
    """

    base: Pose2
    max_distance: float


class SensorMonitor:
    """Detects which sensor, if any, contradicts the others.

    It compares scans with earlier scans and with odometry, odometry with commands and scans, and the wheels
    with both. A sensor is assumed to work unless the data contradict it: a scan without returns may come from
    an empty hall, unless there were walls all around just before.
    """

    def __init__(self) -> None:
        self._base = Pose2()
        self._odometry_stamp: Optional[float] = None
        self._still_since: Optional[float] = None
        self._commanded_at = -math.inf
        self._ranges_when_still: Optional[np.ndarray] = None
        self._ranges: Optional[np.ndarray] = None
        self._base_at_scan, self._frozen_motion, self._frozen_scans = Pose2(), 0.0, 0
        self._reference: Optional[_ReferenceScan] = None
        self._farthest = 0.0
        self._blind_reason = self._frozen_reason = ""
        self._wheels = WheelMonitor()

    def reset(self) -> None:
        """Discard all data, as after a jump of time."""
        self.__init__()  # type: ignore[misc]

    def add_scan(self, ranges: np.ndarray, range_min: float, range_max: float, span: float) -> None:
        """Check a new scan.

        Args:
            ranges: (N,) ranges [m].
            range_min: Shortest valid range [m].
            range_max: Limit of valid ranges [m].
            span: Angle between the outer beams [rad].
        """
        self._blind_reason = self._check_returns(ranges, range_min, range_max, span)
        self._frozen_reason = self._check_frozen(ranges)
        self._ranges = ranges

    def add_odometry(self, now: float, base_in_odom: Pose2, command: Twist2) -> None:
        """Check new odometry.

        Args:
            now: Time [s].
            base_in_odom: Pose from odometry.
            command: Velocity command that the robot follows.
        """
        is_commanded = abs(command.v) > MIN_COMMAND or abs(command.omega) > MIN_COMMAND
        if is_commanded:
            self._commanded_at = now
        if base_in_odom != self._base or now - self._commanded_at > COMMAND_GAP:
            self._still_since = None
        elif self._still_since is None and is_commanded:
            self._still_since, self._ranges_when_still = now, self._ranges
        self._base, self._odometry_stamp = base_in_odom, now
        self._wheels.add_odometry(now, base_in_odom, command)

    def fault(self, now: float) -> Optional[str]:
        """Describe the sensor that cannot be trusted.

        Args:
            now: Time [s].

        Returns:
            Sensor and reason, such as "scan: nearly all of its beams are NaN"; None if there is no fault.
        """
        if self._odometry_stamp is not None and now - self._odometry_stamp > ODOMETRY_TIMEOUT:
            return f"odometry: none for {now - self._odometry_stamp:.1f} s"
        for reason in (self._blind_reason, self._frozen_reason):
            if reason:
                return f"scan: {reason}"
        if self._odometry_is_stuck(now):
            return "odometry: it stands still while the robot is commanded to move and its scans change"
        return self._wheels.fault()

    def _check_returns(self, ranges: np.ndarray, range_min: float, range_max: float, span: float) -> str:
        """Return why a scan's beams cannot be right; empty if they can."""
        if not len(ranges):
            return "it has no beams"
        with np.errstate(invalid="ignore"):
            counts = {
                "NaN": np.count_nonzero(np.isnan(ranges)),
                f"nearer than {range_min:g} m": np.count_nonzero(ranges < max(range_min, 1e-3)),
            }
            returns = ranges[(ranges >= range_min) & (ranges < range_max)]
        is_wide = abs(span) > WIDE_FIELD_OF_VIEW
        for what, count in counts.items():
            if count / len(ranges) >= NEARLY_ALL and is_wide:
                return f"nearly all of its beams are {what}"
        if len(returns) >= ENOUGH_RETURNS * len(ranges):
            max_distance = NEAR if is_wide else self._distance_in_range(returns, range_min)
            self._reference = _ReferenceScan(self._base, max_distance)
        elif len(returns) <= (1.0 - NEARLY_ALL) * len(ranges) and self._reference is not None:
            moved = self._reference.base.inverse() @ self._base
            distance = math.hypot(moved.x, moved.y)
            is_same_view = is_wide or abs(moved.yaw) < SAME_VIEW_FRACTION * abs(span)
            if distance < self._reference.max_distance and is_same_view:
                return f"it has lost sight of everything within {distance:.1f} m"
        return ""

    def _distance_in_range(self, returns: np.ndarray, range_min: float) -> float:
        """Distance the robot can move while at least half of the returns stay in range [m]."""
        self._farthest = max(self._farthest, float(returns.max()))
        margins = np.minimum(returns - range_min, self._farthest - returns)
        return min(NEAR, float(np.median(margins)))

    def _check_frozen(self, ranges: np.ndarray) -> str:
        """Return a reason if scans do not change while odometry does, in several scans; empty otherwise."""
        moved = self._base_at_scan.inverse() @ self._base
        motion, self._base_at_scan = max(math.hypot(moved.x, moved.y), abs(moved.yaw)), self._base
        is_same = self._ranges is not None and np.array_equal(ranges, self._ranges, equal_nan=True)
        if not is_same or not np.isfinite(ranges).any():
            self._frozen_motion, self._frozen_scans = 0.0, 0
        elif motion > MIN_SCAN_MOTION:
            self._frozen_motion, self._frozen_scans = self._frozen_motion + motion, self._frozen_scans + 1
        is_frozen = self._frozen_motion >= FROZEN_MOTION and self._frozen_scans >= FROZEN_SCANS
        return "it stays the same to the last bit while the robot moves" if is_frozen else ""

    def _odometry_is_stuck(self, now: float) -> bool:
        before, after = self._ranges_when_still, self._ranges
        if self._still_since is None or now - self._still_since < ODOMETRY_PATIENCE:
            return False
        if before is None or after is None or len(before) != len(after):
            return False
        both = np.isfinite(before) & np.isfinite(after)
        return bool(both.any()) and float(np.median(np.abs(after[both] - before[both]))) > CHANGED_RANGE
