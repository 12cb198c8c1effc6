"""Poses from mouse clicks and drags on the floor."""

import math
from typing import Iterable, Optional, Tuple

FARTHEST = 500.0
# Length above which a drag defines a direction [m].
SHORTEST_DRAG = 0.15


def floor_intersection(origin: Iterable[float], towards: Iterable[float]) -> Optional[Tuple[float, float]]:
    """Intersect the ray from ``origin`` through ``towards`` with z = 0; None without an intersection."""
    (ox, oy, oz), (tx, ty, tz) = origin, towards
    if abs(tz - oz) < 1e-9:
        return None
    share = oz / (oz - tz)
    x, y = ox + share * (tx - ox), oy + share * (ty - oy)
    if share <= 0.0 or not abs(x) < FARTHEST or not abs(y) < FARTHEST:
        return None
    return x, y


def drag_yaw(start: Tuple[float, float], end: Optional[Tuple[float, float]], otherwise: float) -> float:
    """Return the yaw of a drag from ``start`` to ``end``, or ``otherwise`` if it is too short [rad]."""
    if end is None or math.hypot(end[0] - start[0], end[1] - start[1]) < SHORTEST_DRAG:
        return otherwise
    return math.atan2(end[1] - start[1], end[0] - start[0])


def quaternion_of(yaw: float) -> Tuple[float, float, float, float]:
    """Return the quaternion (x, y, z, w) of a yaw [rad]."""
    return 0.0, 0.0, math.sin(yaw / 2.0), math.cos(yaw / 2.0)
