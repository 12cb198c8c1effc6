"""Turning on the spot."""

import math

from move_base_lite.control.settings import ControllerSettings
from planar import Twist2

BRAKING_SHARE = 0.7


def rotation_towards(settings: ControllerSettings, error: float, twist: Twist2, period: float) -> Twist2:
    """A turn that takes off ``error`` radians of heading, fast but with room to stop; brakes v first."""
    stoppable = math.sqrt(2.0 * BRAKING_SHARE * settings.acc_lim_theta * abs(error))
    speed = min(max(stoppable, settings.min_vel_theta), settings.max_vel_theta, abs(error) / period)
    wanted = math.copysign(speed, error)
    change = settings.acc_lim_theta * period
    omega = min(max(wanted, twist.omega - change), twist.omega + change)
    return Twist2(braked(twist.v, settings.acc_lim_x * period), omega)


def stopping(settings: ControllerSettings, twist: Twist2, period: float) -> Twist2:
    """The nearest to a standstill that the robot can reach in ``period``."""
    return Twist2(
        braked(twist.v, settings.acc_lim_x * period), braked(twist.omega, settings.acc_lim_theta * period)
    )


def braked(speed: float, change: float) -> float:
    return math.copysign(max(abs(speed) - change, 0.0), speed)
