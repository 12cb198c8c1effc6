"""Shortest ways through a map for a round robot."""

import math
from functools import lru_cache
from typing import Optional, Sequence, Tuple

import numpy as np
from scipy.ndimage import label
from scipy.sparse.csgraph import dijkstra

from planar import FREE, OccupancyGrid, Pose2
from planar.geometry.distance_field import distance_field
from planar.geometry.grid_graph import grid_graph

# Metres from a robot's middle to what is solid, on all ways of generated buildings.
PASSAGE_CLEARANCE = 0.35


class ShortestPaths:
    """Ways along cells whose middle is at least ``radius``, metres, from everything that is not free."""

    def __init__(self, grid: OccupancyGrid, radius: float):
        self._grid = grid
        self._traversable = distance_field(grid.cells != FREE, grid.resolution) > radius
        self._graph = grid_graph(self._traversable, grid.resolution)

    def length(self, places: Sequence[Pose2]) -> Optional[float]:
        """Metres from place to place, straight to the nearest open cells; None if there is no way."""
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
        """Number of the nearest open cell, and how far its middle is."""
        cells = np.argwhere(self._traversable)
        distances = np.hypot(*(self._grid.points_of(cells) - (place.x, place.y)).T)
        nearest = int(np.argmin(distances))
        row, col = cells[nearest]
        return int(row * self._grid.cols + col), float(distances[nearest])


def connected_regions(grid: OccupancyGrid, radius: float) -> np.ndarray:
    """Numbers of connected cells where the middle of a robot of that radius can be, (rows, cols); 0: none."""
    return label(distance_field(grid.cells != FREE, grid.resolution) > radius)[0]


@lru_cache(maxsize=8)
def shortest_path_length(grid: OccupancyGrid, places: Tuple[Pose2, ...], radius: float) -> Optional[float]:
    """Metres from place to place for a robot of that radius; None if there is no way."""
    return ShortestPaths(grid, radius).length(places)
