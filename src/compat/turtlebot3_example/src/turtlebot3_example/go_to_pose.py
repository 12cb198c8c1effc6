"""Control towards poses by odometry, and the corners of patrol figures."""

import math
from typing import List, Optional

from planar import Pose2, Twist2, wrap

# Goal tolerances [m, rad] and velocity limits [m/s, rad/s] of ROBOTIS' examples.
POSITION_TOLERANCE, YAW_TOLERANCE = 0.02, 0.05
MAX_VELOCITY = Twist2(0.1, 1.5)
# Heading error beyond which the robot turns on the spot [rad].
MAX_HEADING_ERROR = 0.3
GAIN = 2.0
CIRCLE_CORNERS = 24
# Mode in the action's goal -> number of corners.
FIGURES = {1: 4, 2: 3, 3: CIRCLE_CORNERS}


def velocity_to(base_in_odom: Pose2, goal: Pose2, align_yaw: bool = True) -> Optional[Twist2]:
    """Velocity towards a goal; None if it is reached.

    Args:
        base_in_odom: Pose of the robot.
        goal: Goal pose in ``odom``.
        align_yaw: Whether the robot turns to the goal's yaw.
    """
    offset_x, offset_y = goal.x - base_in_odom.x, goal.y - base_in_odom.y
    distance = math.hypot(offset_x, offset_y)
    if distance > POSITION_TOLERANCE:
        error = wrap(math.atan2(offset_y, offset_x) - base_in_odom.yaw)
        v = min(distance, MAX_VELOCITY.v) if abs(error) < MAX_HEADING_ERROR else 0.0
        return Twist2(v, _limited(GAIN * error))
    error = wrap(goal.yaw - base_in_odom.yaw)
    return None if not align_yaw or abs(error) < YAW_TOLERANCE else Twist2(0.0, _limited(GAIN * error))


def figure_corners(start: Pose2, mode: int, size: float) -> List[Pose2]:
    """Corners of a figure to the left of ``start``, which is its last corner.

    Args:
        start: Pose at which the figure starts.
        mode: 1 square, 2 triangle, 3 circle.
        size: Length of a side, or radius [m].

    Raises:
        ValueError: The mode or the size is invalid.
    """
    if mode not in FIGURES or not (math.isfinite(size) and size > 0.0):
        raise ValueError(f"there is no figure {mode} of {size:g} m")
    corners = FIGURES[mode]
    side = 2.0 * size * math.sin(math.pi / corners) if mode == 3 else size
    step = Pose2(side, 0.0, 0.0) @ Pose2(0.0, 0.0, math.tau / corners)
    corners_in_odom = [start]
    for _ in range(corners):
        corners_in_odom.append(corners_in_odom[-1] @ step)
    return corners_in_odom[1:]


def _limited(omega: float) -> float:
    return min(max(omega, -MAX_VELOCITY.omega), MAX_VELOCITY.omega)
