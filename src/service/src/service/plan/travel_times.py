"""Times of drives from the lengths of paths on the map, corrected by how long drives have taken."""

from typing import Dict, Tuple

import numpy as np

from planar import OccupancyGrid, Pose2
from planar.geometry.grid_paths import GridPaths

# Mean speed of drives in a home, and time to start, turn and stop.
SPEED, OVERHEAD_SECONDS = 0.3, 4.0
# Length of a path by which a straight line is multiplied.
DETOUR = 1.5
# Number of drives whose times are kept.
MAX_CACHED = 10_000


class GridTravelTimes:
    """Times of drives on a map; the distances to each goal are computed once.

    Args:
        grid: The map.
        speed: Mean speed [m/s].
    """

    def __init__(self, grid: OccupancyGrid, speed: float = SPEED):
        self._speed, self._paths = speed, GridPaths(grid)
        self._seconds: Dict[Tuple[float, float, float, float], float] = {}

    def seconds(self, start: Pose2, end: Pose2) -> float:
        """Return the time to drive from one pose to another [s]."""
        key = (start.x, start.y, end.x, end.y)
        seconds = self._seconds.get(key)
        if seconds is None:
            metres = self._metres(start, end)
            seconds = 0.0 if key[:2] == key[2:] else OVERHEAD_SECONDS + metres / self._speed
            if len(self._seconds) >= MAX_CACHED:
                self._seconds.clear()
            self._seconds[key] = seconds
        return seconds

    def _metres(self, start: Pose2, end: Pose2) -> float:
        lengths = self._paths.lengths_from(self._paths.node_at(end.x, end.y))
        metres = float(lengths[self._paths.node_at(start.x, start.y)])
        return metres if np.isfinite(metres) else DETOUR * start.distance_to(end)
