"""Where the robot will be when what is decided now takes effect."""

from typing import Tuple

from planar import Pose2, Twist2

STEPS = 5


def predict_motion(
    twist: Twist2, active_command: Twist2, seconds: float, acceleration: Twist2
) -> Tuple[Pose2, Twist2]:
    """How the robot moves on and how fast it then is.

    ``twist``: of now; ``in_force``: the command that it obeys meanwhile; ``acceleration``: the robot's own.
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


def _towards(now: float, wanted: float, most: float) -> float:
    return min(max(wanted, now - most), now + most)
