"""Checks of odometry: standstill of the robot, and discontinuities since the last scan."""

import math

from planar import Pose2

# Smaller motions, metres or radians, count as standing still.
_STANDSTILL = 1e-3
# Highest speed of a robot [m/s], and jump of odometry [m] that is tolerated besides.
_MAX_SPEED, _JUMP_TOLERANCE = 5.0, 1.0
# Longest time between two scans [s] for which driving is assumed; clocks jump, too.
_MAX_DRIVE_SECONDS = 20.0
# Time without a scan [s] after which a robot whose odometry has not moved may have been carried.
_LONG_GAP = 5.0
# Odometry nearer to zero than this, metres and radians, has been reset.
_AT_ZERO = 0.05


def has_moved(motion: Pose2, threshold: float = _STANDSTILL) -> bool:
    """Check whether a motion exceeds a threshold.

    Args:
        motion: Pose of the base relative to an earlier one.
        threshold: Least distance [m] or rotation [rad].
    """
    return math.hypot(motion.x, motion.y) >= threshold or abs(motion.yaw) >= threshold


class MotionFilter:
    """Drops scans of a standing robot, except one per interval (cartographer: MotionFilter)."""

    def __init__(self, interval: float):
        """Create the filter; it keeps the first scan.

        Args:
            interval: Period of the scans that are kept while the robot stands still [s].
        """
        self._interval = interval
        self._stamp = -math.inf
        self._base_in_odom = Pose2()

    def is_similar(self, base_in_odom: Pose2, stamp: float) -> bool:
        """Check whether a scan can be dropped; otherwise later scans are compared with this one.

        Args:
            base_in_odom: Odometry pose of the base at the scan.
            stamp: Time of the scan [s].
        """
        still = not has_moved(self._base_in_odom.inverse() @ base_in_odom)
        if still and 0.0 <= stamp - self._stamp < self._interval:
            return True
        self._stamp, self._base_in_odom = stamp, base_in_odom
        return False


class DiscontinuityDetector:
    """Detects that odometry does not relate the robot's pose to that of the last scan.

    This is the case if odometry jumps farther than a robot can drive, or if scans pause for long or time
    jumps back while odometry stands still or restarts at zero: the robot may have been carried.
    """

    def __init__(self) -> None:
        self._stamp = math.nan
        self._base_in_odom = Pose2()

    def is_discontinuous(self, base_in_odom: Pose2, stamp: float) -> bool:
        """Check whether the motion since the scan of the last call is unknown.

        Args:
            base_in_odom: Odometry pose of the base at the scan.
            stamp: Time of the scan [s].
        """
        motion, elapsed = self._base_in_odom.inverse() @ base_in_odom, stamp - self._stamp
        self._stamp, self._base_in_odom = stamp, base_in_odom
        if math.isnan(elapsed):
            return False
        drive_seconds = min(max(elapsed, 0.0), _MAX_DRIVE_SECONDS)
        is_jump = math.hypot(motion.x, motion.y) > _JUMP_TOLERANCE + _MAX_SPEED * drive_seconds
        is_gap = not 0.0 <= elapsed < _LONG_GAP
        return is_jump or (is_gap and not (has_moved(motion) and has_moved(base_in_odom, _AT_ZERO)))
