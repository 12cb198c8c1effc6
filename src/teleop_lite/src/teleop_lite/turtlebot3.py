"""Velocity commands from keys, as turtlebot3_teleop computes them (turtlebot3 1.2, turtlebot3_teleop_key)."""

from planar import Twist2

# Maximum velocity of each model; an unknown one has the burger's.
LIMITS = {
    "burger": Twist2(0.22, 2.84),
    "waffle": Twist2(0.26, 1.82),
    "waffle_pi": Twist2(0.26, 1.82),
}
STEP = Twist2(0.01, 0.1)
MOVE_KEYS = {"w": Twist2(1.0, 0.0), "x": Twist2(-1.0, 0.0), "a": Twist2(0.0, 1.0), "d": Twist2(0.0, -1.0)}
STOP_KEYS = "s "
KEYS = {*MOVE_KEYS, *STOP_KEYS}


class SteppedTeleop:
    """Changes the velocity by a step per key and keeps it until the next key.

    Args:
        model: TurtleBot3 model, which decides on the limits; an unknown one has those of ``burger``.

    Attributes:
        full: Target speed and turn rate [m/s, rad/s].
    """

    def __init__(self, model: str = "burger"):
        self._limit = LIMITS.get(model, LIMITS["burger"])
        self.full = Twist2()
        self._command = Twist2()

    def press(self, key: str) -> None:
        """Process a key; an unknown one does nothing."""
        if key in STOP_KEYS:
            self.full = self._command = Twist2()
        direction = MOVE_KEYS.get(key, Twist2())
        self.full = Twist2(
            _within(self.full.v + direction.v * STEP.v, self._limit.v),
            _within(self.full.omega + direction.omega * STEP.omega, self._limit.omega),
        )

    def tick(self, now: float) -> Twist2:
        """Return the velocity command until the next tick, half a step closer to the target."""
        self._command = Twist2(
            self._command.v + _within(self.full.v - self._command.v, STEP.v / 2.0),
            self._command.omega + _within(self.full.omega - self._command.omega, STEP.omega / 2.0),
        )
        return self._command


def _within(value: float, limit: float) -> float:
    return min(max(value, -limit), limit)
