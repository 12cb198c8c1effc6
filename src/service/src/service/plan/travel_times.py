"""Times of drives from the lengths of paths on the map, corrected by how long drives have taken."""

from typing import Dict, Tuple

import numpy as np

from planar import OCCUPIED, OccupancyGrid, Pose2
from planar.geometry.distance_field import distance_field
from planar.geometry.grid_graph import grid_graph

# Mean speed of drives in a home, and time to start, turn and stop.
SPEED, OVERHEAD_SECONDS = 0.3, 4.0
# Radius that must be free around a path [m], and length of a path by which a straight line is multiplied.
CLEARANCE, DETOUR = 0.22, 1.5
# Cells are merged to this size [m].
CELL = 0.1
# Number of drives whose times are kept.
MAX_CACHED = 10_000


class GridTravelTimes:
    """Times of drives on a map; the distances to each goal are computed once.

    Args:
        grid: The map.
        speed: Mean speed [m/s].
    """

    def __init__(self, grid: OccupancyGrid, speed: float = SPEED):
        self._speed = speed
        step = max(1, round(CELL / grid.resolution))
        distances = distance_field(grid.cells == OCCUPIED, grid.resolution)
        is_open = (distances > CLEARANCE) & (grid.cells != OCCUPIED)
        self._is_open, self._step, self._grid = is_open[::step, ::step], step, grid
        self._graph = grid_graph(self._is_open, grid.resolution * step)
        self._open_cells = np.argwhere(self._is_open)
        self._to_goal: Dict[int, np.ndarray] = {}
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
        goal = self._node(end)
        if goal not in self._to_goal:
            from scipy.sparse.csgraph import dijkstra  # late: few users need it

            self._to_goal[goal] = dijkstra(self._graph, directed=False, indices=goal)
        metres = float(self._to_goal[goal][self._node(start)])
        return metres if np.isfinite(metres) else DETOUR * start.distance_to(end)

    def _node(self, pose: Pose2) -> int:
        """Return the open cell nearest to a pose."""
        row, col = self._grid.cells_of([[pose.x, pose.y]])[0] // self._step
        rows, cols = self._is_open.shape
        if not (0 <= row < rows and 0 <= col < cols and self._is_open[row, col]):
            squares = ((self._open_cells - (row, col)) ** 2).sum(axis=1)
            row, col = self._open_cells[int(squares.argmin())]
        return int(row) * cols + int(col)
