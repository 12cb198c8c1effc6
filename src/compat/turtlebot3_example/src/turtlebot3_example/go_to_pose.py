"""From place to place by odometry, and round figures."""

import math
from typing import List, Optional

from planar import Pose2, Twist2, wrap

# As ROBOTIS' examples: metres and radians off that are there, m/s and rad/s at most.
POSITION_TOLERANCE, YAW_TOLERANCE = 0.02, 0.05
MAX_VELOCITY = Twist2(0.1, 1.5)
# Radians off its way beyond which the robot turns on the spot.
MAX_HEADING_ERROR = 0.3
GAIN = 2.0
CIRCLE_CORNERS = 24
# Corners by the mode of the action's goal.
FIGURES = {1: 4, 2: 3, 3: CIRCLE_CORNERS}


def velocity_to(base_in_odom: Pose2, goal: Pose2, align_yaw: bool = True) -> Optional[Twist2]:
    """The velocity towards a goal; None if it is there, and, if it ``turns`` there, looks as it should."""
    offset_x, offset_y = goal.x - base_in_odom.x, goal.y - base_in_odom.y
    distance = math.hypot(offset_x, offset_y)
    if distance > POSITION_TOLERANCE:
        off = wrap(math.atan2(offset_y, offset_x) - base_in_odom.yaw)
        v = min(distance, MAX_VELOCITY.v) if abs(off) < MAX_HEADING_ERROR else 0.0
        return Twist2(v, _limited(GAIN * off))
    off = wrap(goal.yaw - base_in_odom.yaw)
    return None if not align_yaw or abs(off) < YAW_TOLERANCE else Twist2(0.0, _limited(GAIN * off))


def figure_corners(start: Pose2, mode: int, size: float) -> List[Pose2]:
    """The corners after ``start`` of a figure to its left, which ends there.

    ``mode``: 1 square, 2 triangle, 3 circle; ``size``: metres, of a side or the radius. Raises ValueError.
    """
    if mode not in FIGURES or not (math.isfinite(size) and size > 0.0):
        raise ValueError(f"there is no figure {mode} of {size:g} m")
    corners = FIGURES[mode]
    side = 2.0 * size * math.sin(math.pi / corners) if mode == 3 else size
    step = Pose2(side, 0.0, 0.0) @ Pose2(0.0, 0.0, math.tau / corners)
    places = [start]
    for _ in range(corners):
        places.append(places[-1] @ step)
    return places[1:]


def _limited(omega: float) -> float:
    return min(max(omega, -MAX_VELOCITY.omega), MAX_VELOCITY.omega)
