"""Drives about without hitting anything, as turtlebot3_drive does it (turtlebot3_simulations 1.3)."""

import enum
import math

from planar import Twist2, wrap

# Metres ahead and aside that have to be free; how far it turns away from what is not.
CLEARANCE_AHEAD, CLEARANCE_ASIDE, ESCAPE_ANGLE = 0.7, 0.6, math.radians(30.0)
FORWARD, RIGHT_TURN, LEFT_TURN = Twist2(0.3, 0.0), Twist2(0.0, -1.5), Twist2(0.0, 1.5)


class _State(enum.Enum):
    LOOKING = enum.auto()
    RIGHT = enum.auto()
    LEFT = enum.auto()


class Wanderer:
    """Goes ahead where there is room, and else turns away by 30 degrees and looks again."""

    def __init__(self) -> None:
        self._state = _State.LOOKING
        self._from_yaw = 0.0

    def advance(self, ahead: float, left: float, right: float, yaw: float) -> Twist2:
        """The velocity for now. The free distances are metres: straight ahead, 30 degrees to either side."""
        if self._state is not _State.LOOKING and abs(wrap(yaw - self._from_yaw)) >= ESCAPE_ANGLE:
            self._state = _State.LOOKING
        if self._state is _State.LOOKING:
            self._state, self._from_yaw = self._choose_direction(ahead, left, right), yaw
        return {_State.LOOKING: FORWARD, _State.RIGHT: RIGHT_TURN, _State.LEFT: LEFT_TURN}[self._state]

    def _choose_direction(self, ahead: float, left: float, right: float) -> _State:
        if ahead < CLEARANCE_AHEAD or left < CLEARANCE_ASIDE:
            return _State.RIGHT
        return _State.LEFT if right < CLEARANCE_ASIDE else _State.LOOKING
