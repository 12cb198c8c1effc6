"""Lengths of shortest paths on a map, over merged cells with enough clearance."""

from functools import lru_cache

import numpy as np

from planar.geometry.distance_field import distance_field
from planar.geometry.grid import OCCUPIED, OccupancyGrid
from planar.geometry.grid_graph import grid_graph

# Radius that must be free around a path, and size to which cells are merged [m].
CLEARANCE, CELL = 0.22, 0.1
# Number of cells of which the lengths to all others are kept.
MAX_CACHED = 128


class GridPaths:
    """Lengths of shortest paths between points of a map.

    Args:
        grid: The map.
        clearance: Radius that must be free around a path [m].

    Attributes:
        is_open: Whether a path may lead through each merged cell, bool (rows, cols).
    """

    def __init__(self, grid: OccupancyGrid, clearance: float = CLEARANCE):
        self._step = max(1, round(CELL / grid.resolution))
        distances = distance_field(grid.cells == OCCUPIED, grid.resolution)
        is_open = (distances > clearance) & (grid.cells != OCCUPIED)
        self.is_open, self._grid = is_open[:: self._step, :: self._step], grid
        graph = grid_graph(self.is_open, grid.resolution * self._step)
        self._graph = graph + graph.T
        self._open_cells = np.argwhere(self.is_open)
        self._cached = lru_cache(MAX_CACHED)(self._dijkstra)

    def lengths_from(self, node: int) -> np.ndarray:
        """Return the length of the shortest path from a merged cell to each, infinite without one [m].

        Args:
            node: Number of the cell (see ``node_at``).

        Returns:
            Lengths (rows * cols,) by number.
        """
        return self._cached(node)

    def node_at(self, x: float, y: float) -> int:
        """Return the number of the open merged cell nearest to a point of the map."""
        row, col = self._grid.cells_of([[x, y]])[0] // self._step
        rows, cols = self.is_open.shape
        if not (0 <= row < rows and 0 <= col < cols and self.is_open[row, col]):
            squares = ((self._open_cells - (row, col)) ** 2).sum(axis=1)
            row, col = self._open_cells[int(squares.argmin())]
        return int(row) * cols + int(col)

    def _dijkstra(self, node: int) -> np.ndarray:
        from scipy.sparse.csgraph import dijkstra  # late: few users need it

        return np.asarray(dijkstra(self._graph, indices=node))
