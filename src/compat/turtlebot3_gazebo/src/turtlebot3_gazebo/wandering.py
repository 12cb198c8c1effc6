"""Wandering with obstacle avoidance, as turtlebot3_drive (turtlebot3_simulations 1.3)."""

import enum
import math

from planar import Twist2, wrap

# Required clearance ahead and aside [m], and angle by which the robot turns away from obstacles [rad].
CLEARANCE_AHEAD, CLEARANCE_ASIDE, ESCAPE_ANGLE = 0.7, 0.6, math.radians(30.0)
FORWARD, RIGHT_TURN, LEFT_TURN = Twist2(0.3, 0.0), Twist2(0.0, -1.5), Twist2(0.0, 1.5)


class _State(enum.Enum):
    FORWARD = enum.auto()
    RIGHT = enum.auto()
    LEFT = enum.auto()


class Wanderer:
    """Drives ahead while there is clearance, otherwise turns away by 30 degrees."""

    def __init__(self) -> None:
        self._state = _State.FORWARD
        self._from_yaw = 0.0

    def advance(self, ahead: float, left: float, right: float, yaw: float) -> Twist2:
        """Velocity command for one scan.

        Args:
            ahead: Range straight ahead [m].
            left: Range 30 degrees to the left [m].
            right: Range 30 degrees to the right [m].
            yaw: Heading of the robot [rad].
        """
        if self._state is not _State.FORWARD and abs(wrap(yaw - self._from_yaw)) >= ESCAPE_ANGLE:
            self._state = _State.FORWARD
        if self._state is _State.FORWARD:
            self._state, self._from_yaw = self._choose_direction(ahead, left, right), yaw
        return {_State.FORWARD: FORWARD, _State.RIGHT: RIGHT_TURN, _State.LEFT: LEFT_TURN}[self._state]

    def _choose_direction(self, ahead: float, left: float, right: float) -> _State:
        if ahead < CLEARANCE_AHEAD or left < CLEARANCE_ASIDE:
            return _State.RIGHT
        return _State.LEFT if right < CLEARANCE_ASIDE else _State.FORWARD
