"""Whether the robot goes on from where it was: it may stand still, or be somewhere else all at once."""

import math

from planar import Pose2
from slam_lite.front_end import moves

# No robot drives faster, m/s; and what odometry may jump besides, metres.
_FASTEST, _JUMP = 5.0, 1.0
# How many seconds of a pause of the scans a robot may have driven: clocks jump, too.
_LONGEST_DRIVE = 20.0
# After so many seconds without a scan a robot that has not moved may have been carried.
_LONG_GAP = 5.0
# Odometry nearer to zero than this, metres and radians, has begun anew.
_AT_ZERO = 0.05


class Pause:
    """Tells when the robot stands still, so that its scans need only be looked at now and then."""

    def __init__(self, interval: float):
        self._interval = interval
        self._stamp = -math.inf
        self._base_in_odom = Pose2()

    def lasts(self, base_in_odom: Pose2, stamp: float) -> bool:
        still = not moves(self._base_in_odom.inverse() @ base_in_odom)
        if still and 0.0 <= stamp - self._stamp < self._interval:
            return True
        self._stamp, self._base_in_odom = stamp, base_in_odom
        return False


class Continuity:
    """Tells when odometry does not say where the robot is now as seen from where it was.

    So it is when odometry jumps as no robot moves, and when scans pause for long, or time jumps back, and
    odometry meanwhile tells of no way or begins at zero again: the robot may have been carried.
    """

    def __init__(self) -> None:
        self._stamp = math.nan
        self._base_in_odom = Pose2()

    def breaks(self, base_in_odom: Pose2, stamp: float) -> bool:
        """Takes in one scan; whether it is not known to go on from the one before."""
        motion, elapsed = self._base_in_odom.inverse() @ base_in_odom, stamp - self._stamp
        self._stamp, self._base_in_odom = stamp, base_in_odom
        if math.isnan(elapsed):
            return False
        is_jump = math.hypot(motion.x, motion.y) > _JUMP + _FASTEST * min(max(elapsed, 0.0), _LONGEST_DRIVE)
        is_gap = not 0.0 <= elapsed < _LONG_GAP
        return is_jump or (is_gap and not (moves(motion) and moves(base_in_odom, _AT_ZERO)))
