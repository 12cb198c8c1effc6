"""Prediction of the robot's motion during the latency of a command."""

import math
from typing import Tuple

import numba

from planar import Pose2, Twist2

STEPS = 5


def predict_motion(
    twist: Twist2, active_command: Twist2, seconds: float, acceleration: Twist2
) -> Tuple[Pose2, Twist2]:
    """Predict the robot's pose and velocity when the next command takes effect.

    Args:
        twist: Present velocity.
        active_command: Velocity command that the robot follows until then.
        seconds: Time until then [s].
        acceleration: Limits of acceleration [m/s^2, rad/s^2].

    Returns:
        Predicted pose in the present base frame, and velocity at that pose.
    """
    if seconds <= 0.0:
        return Pose2(), twist
    limits = acceleration.v, acceleration.omega
    x, y, yaw, v, omega = _predicted(
        twist.v, twist.omega, active_command.v, active_command.omega, *limits, seconds
    )
    return Pose2(x, y, yaw), Twist2(v, omega)


@numba.njit(cache=True)
def _predicted(v, omega, commanded_v, commanded_omega, acceleration, turn_acceleration, seconds):
    x, y, yaw, dt = 0.0, 0.0, 0.0, seconds / STEPS
    for _ in range(STEPS):
        v_after = _towards(v, commanded_v, acceleration * dt)
        omega_after = _towards(omega, commanded_omega, turn_acceleration * dt)
        distance, turned = 0.5 * (v + v_after) * dt, 0.5 * (omega + omega_after) * dt
        x += distance * math.cos(yaw + 0.5 * turned)
        y += distance * math.sin(yaw + 0.5 * turned)
        yaw += turned
        v, omega = v_after, omega_after
    return x, y, yaw, v, omega


@numba.njit(cache=True)
def _towards(value, target, max_change):
    return min(max(target, value - max_change), value + max_change)
