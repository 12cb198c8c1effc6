"""Poses from mouse clicks and drags on the floor."""

import math
from typing import Iterable, Optional, Tuple

FARTHEST = 500.0
# Length above which a drag defines a direction [m].
SHORTEST_DRAG = 0.15


def floor_intersection(origin: Iterable[float], towards: Iterable[float]) -> Optional[Tuple[float, float]]:
    """Intersect a ray with the floor, z = 0.

    Args:
        origin: Start (3,) of the ray [m].
        towards: Another point (3,) of the ray [m].

    Returns:
        x and y [m]; None without an intersection.
    """
    (ox, oy, oz), (tx, ty, tz) = origin, towards
    if abs(tz - oz) < 1e-9:
        return None
    share = oz / (oz - tz)
    x, y = ox + share * (tx - ox), oy + share * (ty - oy)
    if share <= 0.0 or not abs(x) < FARTHEST or not abs(y) < FARTHEST:
        return None
    return x, y


def drag_yaw(start: Tuple[float, float], end: Optional[Tuple[float, float]], otherwise: float) -> float:
    """Return the yaw of a drag [rad].

    Args:
        start: Where the mouse was pressed, x and y [m].
        end: Where it was released; None for a click.
        otherwise: Yaw if the drag is too short to have a direction [rad].
    """
    if end is None or math.hypot(end[0] - start[0], end[1] - start[1]) < SHORTEST_DRAG:
        return otherwise
    return math.atan2(end[1] - start[1], end[0] - start[0])


def quaternion_of(yaw: float) -> Tuple[float, float, float, float]:
    """Return the quaternion (x, y, z, w) of a yaw [rad]."""
    return 0.0, 0.0, math.sin(yaw / 2.0), math.cos(yaw / 2.0)
