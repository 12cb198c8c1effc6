"""From a mouse over the floor to poses."""

import math
from typing import Iterable, Optional, Tuple

FARTHEST = 500.0
# Metres that a drag must be long before it gives a direction.
SHORTEST_DRAG = 0.15


def on_floor(origin: Iterable[float], towards: Iterable[float]) -> Optional[Tuple[float, float]]:
    """Where the ray from ``origin`` by way of the point ``towards`` meets z = 0; None if it does not."""
    (ox, oy, oz), (tx, ty, tz) = origin, towards
    if abs(tz - oz) < 1e-9:
        return None
    share = oz / (oz - tz)
    x, y = ox + share * (tx - ox), oy + share * (ty - oy)
    if share <= 0.0 or not abs(x) < FARTHEST or not abs(y) < FARTHEST:
        return None
    return x, y


def facing(start: Tuple[float, float], end: Optional[Tuple[float, float]], otherwise: float) -> float:
    """The yaw of a press at ``start``, released at ``end``: that of the drag, if there was one."""
    if end is None or math.hypot(end[0] - start[0], end[1] - start[1]) < SHORTEST_DRAG:
        return otherwise
    return math.atan2(end[1] - start[1], end[0] - start[0])


def quaternion_of(yaw: float) -> Tuple[float, float, float, float]:
    """As x, y, z, w."""
    return 0.0, 0.0, math.sin(yaw / 2.0), math.cos(yaw / 2.0)
