"""Wheel drives: the contract, and the base controller that turns velocity commands into wheel speeds."""

import math
from dataclasses import dataclass
from typing import Protocol, Tuple

from planar import Twist2

# Times a second that a base sets its motors; Kobuki's tells its odometry as often.
BASE_RATE = 50


class WheelDrive(Protocol):
    """A drive, or what stands before one: commanded now and then, asked each time that the motors are set."""

    def command(self, twist: Twist2) -> None:
        """Takes a new command; one that is not finite stops the robot."""

    def switch(self, on: bool) -> None:
        """Without power the motors brake and no command is heard."""

    def halt(self) -> None:
        """Forgets the command and stands still at once."""

    def wheel_speeds(self, seconds: float) -> Tuple[float, float]:
        """Speeds of the left and right wheels, rad/s, after ``seconds`` more."""


@dataclass(frozen=True)
class DriveProfile:
    """Driven wheels on both sides: radius and separation in metres, torque in N m, limits in SI units.

    The robot stops when no command has come for ``command_timeout`` seconds.
    """

    left_joints: Tuple[str, ...]
    right_joints: Tuple[str, ...]
    wheel_radius: float
    wheel_separation: float
    torque: float
    command_topics: Tuple[str, ...] = ("cmd_vel",)
    max_speed: float = math.inf
    max_turn_rate: float = math.inf
    max_acceleration: float = math.inf
    max_turn_acceleration: float = math.inf
    command_timeout: float = math.inf

    @property
    def joints(self) -> Tuple[str, ...]:
        """Of all driven wheels, those on the left first."""
        return self.left_joints + self.right_joints


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
