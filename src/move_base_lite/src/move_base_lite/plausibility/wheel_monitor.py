"""Wheels that do not do what they are told: the robot turns where it should drive straight."""

import math
from typing import Optional

from planar import Pose2, Twist2

# Metres told over which evidence counts, and metres of evidence that are no chance.
MEMORY, ENOUGH = 2.0, 1.0
# Radians turned unasked with each metre told. A wheel of 0.23 m track that stands turns the robot by 4.3; one
# that is a fifth too slow by 0.9, and the controller makes up for that.
UNASKED = 2.2
# Seconds between two odometries that belong together, and rad/s that are a jump and no motion.
LONGEST_STEP, FASTEST = 0.5, 6.0
# Rates, m/s and rad/s, below which the robot stands.
STANDING = 1e-3
# Weight of the belief that nothing turns, in the sums.
PRIOR = 1e-3
# Seconds after which it may be tried again.
REST = 30.0


class WheelMonitor:
    """Held against commands, odometry tells how much the robot turns with each metre and each radian told.

    Linear regression of the turn driven on the velocities told, by least squares with exponential forgetting.
    A robot that stands tells nothing about its wheels.
    """

    def __init__(self) -> None:
        self._base, self._at = Pose2(), -math.inf
        self._stuck_at: Optional[float] = None
        self._reset()

    def add_odometry(self, now: float, base_in_odom: Pose2, command: Twist2) -> None:
        """Where odometry believes the robot to be, and what the robot has been told to do."""
        moved, seconds = self._base.inverse() @ base_in_odom, now - self._at
        self._base, self._at = base_in_odom, now
        if self._stuck_at is not None and now - self._stuck_at > REST:
            self._stuck_at = None
            self._reset()
        if not 0.0 < seconds < LONGEST_STEP:
            return
        turned = moved.yaw / seconds
        stands = max(math.hypot(moved.x, moved.y) / seconds, abs(turned)) < STANDING
        if not stands and abs(turned) < FASTEST:
            self._learn(command, turned, seconds)
        if self._stuck_at is None and self._way > ENOUGH and abs(self._turn_per_metre()) > UNASKED:
            self._stuck_at = now

    def fault(self) -> Optional[str]:
        """Which wheel does not do what it is told, for people; None if both do."""
        if self._stuck_at is None:
            return None
        turn = self._turn_per_metre()
        side = "left" if turn > 0.0 else "right"
        return f"drive: {abs(turn):.1f} rad turned with each metre told: does the {side} wheel turn?"

    def _reset(self) -> None:
        self._way = self._vv = self._vw = self._ww = self._vt = self._wt = 0.0

    def _learn(self, told: Twist2, turned: float, seconds: float) -> None:
        """Adds to the sums of products of what was told, and of that with the turn."""
        way = abs(told.v) * seconds
        keep = math.exp(-way / MEMORY)
        self._way = keep * self._way + way
        self._vv = keep * self._vv + seconds * told.v * told.v
        self._vw = keep * self._vw + seconds * told.v * told.omega
        self._ww = keep * self._ww + seconds * told.omega * told.omega
        self._vt = keep * self._vt + seconds * told.v * turned
        self._wt = keep * self._wt + seconds * told.omega * turned

    def _turn_per_metre(self) -> float:
        vv, ww = self._vv + PRIOR, self._ww + PRIOR
        return (self._vt * ww - self._wt * self._vw) / (vv * ww - self._vw * self._vw)
