"""From commands to wheel speeds: limits, ramps and the time-out of a mobile base."""

from typing import Tuple

from planar import Twist2
from sim_bridge.driving.profile import DriveProfile


class RampedDrive:
    """Turns the last command into speeds of the wheels, as the base's own controller does."""

    def __init__(self, profile: DriveProfile):
        self._profile = profile
        self._target = Twist2()
        # What is set now, as plain numbers: they change before each step of physics.
        self._v = self._omega = 0.0
        self._speeds = (0.0, 0.0)
        self._age = 0.0
        self._has_power = True

    def switch(self, on: bool) -> None:
        self._has_power = on
        if not on:
            self._target = Twist2()

    def command(self, twist: Twist2) -> None:
        limits = self._profile
        self._age = 0.0
        self._target = Twist2()
        if self._has_power and twist.is_finite():
            self._target = Twist2(_clip(twist.v, limits.max_speed), _clip(twist.omega, limits.max_turn_rate))

    def halt(self) -> None:
        self._target = Twist2()
        self._v = self._omega = 0.0
        self._speeds = (0.0, 0.0)

    def wheel_speeds(self, seconds: float) -> Tuple[float, float]:
        self._age += seconds
        if self._age > self._profile.command_timeout + 1e-9:
            self._target = Twist2()
        if self._v != self._target.v or self._omega != self._target.omega:
            self._ramp(seconds)
        return self._speeds

    def _ramp(self, seconds: float) -> None:
        limits = self._profile
        self._v = _approach(self._v, self._target.v, limits.max_acceleration * seconds)
        self._omega = _approach(self._omega, self._target.omega, limits.max_turn_acceleration * seconds)
        outward = self._omega * limits.wheel_separation / 2.0
        self._speeds = (
            (self._v - outward) / limits.wheel_radius,
            (self._v + outward) / limits.wheel_radius,
        )


def _clip(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))


def _approach(value: float, target: float, step: float) -> float:
    change = target - value
    if change > step:
        return value + step
    return value + change if change >= -step else value - step
