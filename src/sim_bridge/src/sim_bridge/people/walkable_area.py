"""Where people can walk: how far it is to walls, and how far to each goal by the shortest way."""

import numpy as np

from planar import FREE, Pose2
from planar.geometry.distance_field import distance_field
from planar.geometry.ways import grid_graph
from sim_bridge.errors import WorldError
from sim_bridge.views.true_map import true_map
from sim_bridge.world import World

# Side of a cell, metres; how much room ways leave beside the narrowest person, and for how long a way counts
# where there is none.
RESOLUTION, ROOM, UNREACHABLE = 0.1, 0.25, 1e6


class WalkableArea:
    """The free ground of a world around a place; ``walls`` (rows, cols): metres to what is solid."""

    def __init__(self, world: World, inside: Pose2):
        grid = true_map(world, resolution=RESOLUTION, inside=(inside.x, inside.y))
        self.origin_xy = np.array([grid.origin.x, grid.origin.y])
        self.walls = distance_field(grid.cells != FREE, RESOLUTION).astype(float)
        self._is_open = self.walls > ROOM
        self._graph = grid_graph(self._is_open, RESOLUTION)
        self._world, self._grid = world.name, grid

    def distances_to(self, goals_xy: np.ndarray) -> np.ndarray:
        """Metres to each of the goals (N, 2) from each cell, (N, rows, cols). Raises WorldError."""
        from scipy.sparse.csgraph import dijkstra  # late: few worlds have people

        ways = dijkstra(self._graph, directed=False, indices=[self._node_at(*goal) for goal in goals_xy])
        ways[~np.isfinite(ways)] = UNREACHABLE
        return ways.reshape(-1, *self.walls.shape)

    def remaining_distance(self, ways: np.ndarray, x: float, y: float) -> float:
        """Metres from a place to the goal that ``ways`` (rows, cols) lead to."""
        ((row, col),) = self._grid.cells_of([[x, y]])
        return float(ways[row, col])

    def _node_at(self, x: float, y: float) -> int:
        ((row, col),) = self._grid.cells_of([[x, y]])
        if not (self._grid.contains(np.array([[row, col]]))[0] and self._is_open[row, col]):
            raise WorldError(f"world '{self._world}': a person cannot stand at ({x:g}, {y:g})")
        return int(row * self._grid.cols + col)
