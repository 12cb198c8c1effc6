"""Shortest paths of a circular robot on a map."""

import math
from functools import lru_cache
from typing import Optional, Sequence, Tuple

import numpy as np
from scipy.ndimage import label
from scipy.sparse.csgraph import dijkstra

from planar import FREE, OccupancyGrid, Pose2
from planar.geometry.distance_field import distance_field
from planar.geometry.grid_graph import grid_graph

# Minimum distance from the robot's centre to obstacles on all paths of generated buildings [m].
PASSAGE_CLEARANCE = 0.35


class ShortestPaths:
    """Shortest paths over cells with sufficient clearance.

    Args:
        grid: Map.
        radius: Minimum distance of a cell's centre from cells that are not free [m].
    """

    def __init__(self, grid: OccupancyGrid, radius: float):
        self._grid = grid
        self._traversable = distance_field(grid.cells != FREE, grid.resolution) > radius
        self._graph = grid_graph(self._traversable, grid.resolution)

    def length(self, places: Sequence[Pose2]) -> Optional[float]:
        """Return the path length through poses in order [m]; None if one cannot be reached."""
        total = 0.0
        for start, end in zip(places, places[1:]):
            (first, to_first), (last, from_last) = (
                self._nearest_traversable(start),
                self._nearest_traversable(end),
            )
            length = float(dijkstra(self._graph, directed=False, indices=first)[last])
            if not math.isfinite(length):
                return None
            total += to_first + length + from_last
        return total

    def _nearest_traversable(self, place: Pose2) -> Tuple[int, float]:
        """Index of the nearest traversable cell, and the distance to its centre [m]."""
        cells = np.argwhere(self._traversable)
        distances = np.hypot(*(self._grid.points_of(cells) - (place.x, place.y)).T)
        nearest = int(np.argmin(distances))
        row, col = cells[nearest]
        return int(row * self._grid.cols + col), float(distances[nearest])


def connected_regions(grid: OccupancyGrid, radius: float) -> np.ndarray:
    """Label the regions a robot of this radius can traverse: int (rows, cols), 0: not traversable."""
    return label(distance_field(grid.cells != FREE, grid.resolution) > radius)[0]


@lru_cache(maxsize=8)
def shortest_path_length(grid: OccupancyGrid, places: Tuple[Pose2, ...], radius: float) -> Optional[float]:
    """Return the path length through poses for a robot of this radius [m]; None if one cannot be reached."""
    return ShortestPaths(grid, radius).length(places)
