"""The area in which pedestrians can walk: distances to walls, and path lengths to goals."""

import numpy as np

from planar import FREE, Pose2
from planar.geometry.distance_field import distance_field
from planar.geometry.grid_graph import grid_graph
from sim_bridge.errors import WorldError
from sim_bridge.views.true_map import true_map
from sim_bridge.world import World

# Size of a cell [m], distance of paths from walls [m], and path length where there is no path [m].
RESOLUTION, WALL_DISTANCE, UNREACHABLE = 0.1, 0.25, 1e6


class WalkableArea:
    """The free area of a world that contains a point.

    Args:
        world: The world.
        inside: A point in free space; its yaw is ignored.

    Attributes:
        origin_xy: Corner of the grid (2,) in the world [m].
        walls: Distance of each cell to the nearest solid (rows, cols) [m].
    """

    def __init__(self, world: World, inside: Pose2):
        grid = true_map(world, resolution=RESOLUTION, inside=(inside.x, inside.y))
        self.origin_xy = np.array([grid.origin.x, grid.origin.y])
        self.walls = distance_field(grid.cells != FREE, RESOLUTION).astype(float)
        self._is_open = self.walls > WALL_DISTANCE
        self._graph = grid_graph(self._is_open, RESOLUTION)
        self._world, self._grid = world.name, grid

    def distances_to(self, goals_xy: np.ndarray) -> np.ndarray:
        """Return the path lengths to goals.

        Args:
            goals_xy: Goals (N, 2) in the world [m].

        Returns:
            Path length (N, rows, cols) from each cell to each goal [m].

        Raises:
            WorldError: A goal is not in the area.
        """
        from scipy.sparse.csgraph import dijkstra  # late: few worlds have people

        distances = dijkstra(self._graph, directed=False, indices=[self._node_at(*goal) for goal in goals_xy])
        distances[~np.isfinite(distances)] = UNREACHABLE
        return distances.reshape(-1, *self.walls.shape)

    def _node_at(self, x: float, y: float) -> int:
        ((row, col),) = self._grid.cells_of([[x, y]])
        if not (self._grid.contains(np.array([[row, col]]))[0] and self._is_open[row, col]):
            raise WorldError(f"world '{self._world}': a person cannot stand at ({x:g}, {y:g})")
        return int(row * self._grid.cols + col)
