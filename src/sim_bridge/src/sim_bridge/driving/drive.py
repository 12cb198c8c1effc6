"""Wheel drives: the contract, and the base controller that turns velocity commands into wheel speeds."""

import math
from dataclasses import dataclass, replace
from typing import Protocol, Tuple

from planar import Twist2

# Rate at which a base sets its motors [Hz]; Kobuki's odometry has the same.
BASE_RATE = 50
# Time without motion after which a base counts as standing [s].
REST_SECONDS = 6.0


class WheelDrive(Protocol):
    """Contract of a drive and of its wrappers: turns velocity commands into wheel speeds."""

    def command(self, twist: Twist2) -> None:
        """Set the velocity command.

        Args:
            twist: Speed [m/s] and turn rate [rad/s]; one that is not finite stops the robot.
        """

    def switch(self, on: bool) -> None:
        """Switch motor power; without it the motors brake and commands are ignored."""

    def halt(self) -> None:
        """Discard the command and stop at once."""

    def wheel_speeds(self, seconds: float) -> Tuple[float, float]:
        """Advance the drive and return the target wheel speeds.

        Args:
            seconds: Time since the last call [s].

        Returns:
            Speeds of the left and of the right wheels [rad/s].
        """


@dataclass(frozen=True)
class DriveProfile:
    """Parameters of a drive with driven wheels on both sides, or of an omnidirectional one without wheels.

    The latter turns as if it had wheels of radius 1 m, 2 m apart; its lateral speed needs none.

    Attributes:
        left_joints: Joints of the wheels on the left.
        right_joints: Joints of the wheels on the right.
        wheel_radius: Radius of the wheels [m].
        wheel_separation: Distance between left and right wheels [m].
        torque: Largest torque of each motor [N m].
        command_topics: Topics of velocity commands.
        max_speed: Largest speed [m/s].
        max_turn_rate: Largest turn rate [rad/s].
        max_acceleration: Largest acceleration [m/s^2].
        max_turn_acceleration: Largest angular acceleration [rad/s^2].
        command_timeout: Time without a command after which the robot stops [s].
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
    def is_omnidirectional(self) -> bool:
        """Whether the base moves in any direction without driven wheels."""
        return not self.joints

    @property
    def joints(self) -> Tuple[str, ...]:
        """Joints of all driven wheels, those on the left first."""
        return self.left_joints + self.right_joints


class RampedDrive:
    """The controller of a base: limits speed and acceleration and stops after the command time-out.

    Args:
        profile: Geometry and limits.
    """

    def __init__(self, profile: DriveProfile):
        self._profile = profile
        self._target = Twist2()
        # Present velocities, as plain floats: they change at each update.
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
        rim_speed = self._omega * limits.wheel_separation / 2.0
        self._speeds = (
            (self._v - rim_speed) / limits.wheel_radius,
            (self._v + rim_speed) / limits.wheel_radius,
        )


class OmnidirectionalDrive(RampedDrive):
    """The controller of a base that also moves sideways, at once (gazebo_ros_planar_move)."""

    @property
    def lateral_speed(self) -> float:
        """Commanded speed to the left [m/s]."""
        return self._target.lateral

    def command(self, twist: Twist2) -> None:
        super().command(twist)
        if self._has_power and twist.is_finite():
            self._target = replace(self._target, lateral=twist.lateral)


def _clip(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))


def _approach(value: float, target: float, step: float) -> float:
    change = target - value
    if change > step:
        return value + step
    return value + change if change >= -step else value - step
