"""Prediction of the robot's motion during the latency of a command."""

from typing import Tuple

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
    moved, dt = Pose2(), seconds / STEPS
    for _ in range(STEPS if seconds > 0.0 else 0):
        after = Twist2(
            _towards(twist.v, active_command.v, acceleration.v * dt),
            _towards(twist.omega, active_command.omega, acceleration.omega * dt),
        )
        v, turned = 0.5 * (twist.v + after.v), 0.5 * (twist.omega + after.omega) * dt
        moved = moved @ Pose2(0.0, 0.0, 0.5 * turned) @ Pose2(v * dt, 0.0, 0.5 * turned)
        twist = after
    return moved, twist


def _towards(value: float, target: float, max_change: float) -> float:
    return min(max(target, value - max_change), value + max_change)
