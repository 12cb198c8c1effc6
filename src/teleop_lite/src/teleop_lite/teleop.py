"""Velocity commands from keys, as turtlebot_teleop computes them (turtlebot 2.4, turtlebot_teleop_key)."""

from typing import Optional

from planar import Twist2
from teleop_lite.config import TeleopSettings

# Directions as shares of full speed and full turn rate.
MOVE_KEYS = {
    "u": Twist2(1.0, 1.0),
    "i": Twist2(1.0, 0.0),
    "o": Twist2(1.0, -1.0),
    "j": Twist2(0.0, 1.0),
    "l": Twist2(0.0, -1.0),
    "m": Twist2(-1.0, -1.0),
    ",": Twist2(-1.0, 0.0),
    ".": Twist2(-1.0, 1.0),
}
# Factors on full speed and full turn rate.
SPEED_KEYS = {
    "q": Twist2(1.1, 1.1),
    "z": Twist2(0.9, 0.9),
    "w": Twist2(1.1, 1.0),
    "x": Twist2(0.9, 1.0),
    "e": Twist2(1.0, 1.1),
    "c": Twist2(1.0, 0.9),
}
STOP_KEYS = "k "

TICK_SECONDS = 0.1
# Maximum change of the velocity per tick [m/s, rad/s].
RAMP = Twist2(0.02, 0.1)
# Time without repetition after which a key counts as released; keyboards repeat a held key faster [s].
RELEASE_SECONDS = 0.5
TIME_TOLERANCE = 1e-6


class Teleop:
    """Ramps the velocity towards that of the pressed key, and to zero when no key is held.

    Args:
        settings: Initial full speed and turn rate.

    Attributes:
        full: Full speed and turn rate [m/s, rad/s].
    """

    def __init__(self, settings: TeleopSettings = TeleopSettings()):
        self.full = Twist2(settings.scale_linear, settings.scale_angular)
        self._direction = Twist2()
        self._command = Twist2()
        self._is_pressed = False
        self._pressed_at: Optional[float] = None

    def press(self, key: str) -> None:
        """Process a key; an unknown one stops the robot smoothly."""
        if key in SPEED_KEYS:
            factor = SPEED_KEYS[key]
            self.full = Twist2(self.full.v * factor.v, self.full.omega * factor.omega)
        else:
            self._direction = MOVE_KEYS.get(key, Twist2())
        if key in STOP_KEYS:
            self._command = Twist2()
        self._is_pressed = True

    def tick(self, now: float) -> Twist2:
        """Return the velocity command for the next TICK_SECONDS.

        Args:
            now: Time of a monotonic clock [s].
        """
        if self._is_pressed:
            self._is_pressed, self._pressed_at = False, now
        elif self._pressed_at is not None and now - self._pressed_at > RELEASE_SECONDS - TIME_TOLERANCE:
            self._direction, self._pressed_at = Twist2(), None
        self._command = Twist2(
            _approach(self._command.v, self.full.v * self._direction.v, RAMP.v),
            _approach(self._command.omega, self.full.omega * self._direction.omega, RAMP.omega),
        )
        return self._command


def _approach(value: float, target: float, step: float) -> float:
    return min(target, value + step) if target > value else max(target, value - step)
