"""Detects a wheel that does not turn: the robot turns although it should drive straight."""

import math
from typing import Optional

from planar import Pose2, Twist2, wrap

# Commanded distance [m] over which evidence decays, and evidence [m] that cannot be chance.
DECAY_DISTANCE, MIN_EVIDENCE = 2.0, 1.0
# Rotation per commanded metre [rad/m] that means a stuck wheel. A wheel that stands, with a track of 0.23 m,
# turns the robot by 4.3; one that is 20 % too slow by 0.9, which the controller compensates.
STUCK_RAD_PER_METRE = 2.2
# Longest time between two consecutive odometry messages [s], and turn rates that are jumps, not motion
# [rad/s].
MAX_INTERVAL, MAX_TURN_RATE = 0.5, 6.0
# Rates, m/s and rad/s, below which the robot stands.
STANDING = 1e-3
# Regularisation of the regression: weight of the prior that the robot does not turn.
PRIOR = 1e-3
# Seconds after which a stuck wheel is checked again.
RETRY_AFTER = 30.0


class WheelMonitor:
    """Estimates how far the robot turns per commanded metre and per commanded radian.

    Least-squares regression of the measured turn rate on the commanded velocities, with exponential decay.
    Data of a robot that stands are not used.
    """

    def __init__(self) -> None:
        self._base, self._stamp = Pose2(), -math.inf
        self._stuck_since: Optional[float] = None
        self._reset()

    def add_odometry(self, now: float, base_in_odom: Pose2, command: Twist2) -> None:
        """Update the estimate.

        Args:
            now: Time [s].
            base_in_odom: Pose from odometry.
            command: Velocity command that the robot follows.
        """
        before, seconds = self._base, now - self._stamp
        self._base, self._stamp = base_in_odom, now
        if self._stuck_since is not None and now - self._stuck_since > RETRY_AFTER:
            self._stuck_since = None
            self._reset()
        if not 0.0 < seconds < MAX_INTERVAL:
            return
        turn_rate = wrap(base_in_odom.yaw - before.yaw) / seconds
        stands = max(before.distance_to(base_in_odom) / seconds, abs(turn_rate)) < STANDING
        if not stands and abs(turn_rate) < MAX_TURN_RATE:
            self._update_sums(command, turn_rate, seconds)
        has_evidence = self._stuck_since is None and self._distance > MIN_EVIDENCE
        if has_evidence and abs(self._turn_per_metre()) > STUCK_RAD_PER_METRE:
            self._stuck_since = now

    def fault(self) -> Optional[str]:
        """Describe which wheel is stuck; None if both turn."""
        if self._stuck_since is None:
            return None
        turn = self._turn_per_metre()
        side = "left" if turn > 0.0 else "right"
        return f"drive: {abs(turn):.1f} rad turned per commanded metre: does the {side} wheel turn?"

    def _reset(self) -> None:
        self._distance = self._vv = self._vw = self._ww = self._vt = self._wt = 0.0

    def _update_sums(self, command: Twist2, turn_rate: float, seconds: float) -> None:
        """Add the products of commanded velocities and turn rate to the decayed sums."""
        distance = abs(command.v) * seconds
        decay = math.exp(-distance / DECAY_DISTANCE)
        self._distance = decay * self._distance + distance
        self._vv = decay * self._vv + seconds * command.v * command.v
        self._vw = decay * self._vw + seconds * command.v * command.omega
        self._ww = decay * self._ww + seconds * command.omega * command.omega
        self._vt = decay * self._vt + seconds * command.v * turn_rate
        self._wt = decay * self._wt + seconds * command.omega * turn_rate

    def _turn_per_metre(self) -> float:
        vv, ww = self._vv + PRIOR, self._ww + PRIOR
        return (self._vt * ww - self._wt * self._vw) / (vv * ww - self._vw * self._vw)
