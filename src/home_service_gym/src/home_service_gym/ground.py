"""Where a robot can stand and drive in an arena, and how far it is from there to a goal."""

import math
from collections import OrderedDict
from functools import cached_property
from typing import Dict, Optional, Tuple

import numpy as np
from scipy.spatial.distance import cdist

from explorer_lite.travel import travel_distances
from planar import FREE, OccupancyGrid, Pose2
from planar.geometry.distance_field import distance_field

# Metres from a robot's middle to what is solid: where it is put, and on its ways.
ROOM_TO_STAND, ROOM_TO_PASS = 0.4, 0.35
STATIONS = 16
KEPT_GOALS = 4
NOBODY = np.empty((0, 3))


class Ground:
    """``grid``: free is what can be reached from ``start``; ``crowd`` (N, 3): x, y and radius of what moves.

    Nobody is put where something that moves begins.
    """

    def __init__(self, grid: OccupancyGrid, start: Pose2, crowd: np.ndarray = NOBODY):
        self.grid = grid
        self._map_in_grid = grid.origin.inverse()
        self._room = distance_field(grid.cells != FREE, grid.resolution)
        from_start = travel_distances(grid, self._room, start, ROOM_TO_PASS)
        self._to_goals: OrderedDict[Pose2, np.ndarray] = OrderedDict()
        self._to_stations: Dict[int, np.ndarray] = {}
        self._ways: Dict[Tuple[int, int], np.ndarray] = {}
        standing = np.argwhere((self._room > ROOM_TO_STAND) & np.isfinite(from_start))
        gaps = cdist(grid.points_of(standing), crowd[:, :2]) - crowd[:, 2]
        self._standing = standing[(gaps > ROOM_TO_STAND).all(axis=1)]

    def place(
        self, rng: np.random.Generator, distances: Optional[np.ndarray] = None, least: float = 0.0
    ) -> Pose2:
        """Anywhere with room, turned anyhow; of ``distances`` to a goal (see ``distances_to``) at least one.

        If nowhere is that far from the goal, the place that comes nearest to it.
        """
        cells = self._standing
        if distances is not None:
            ways = distances[cells[:, 0], cells[:, 1]]
            far = np.isfinite(ways) & (ways >= least)
            cells = (
                cells[far] if far.any() else cells[[int(np.argmax(np.where(np.isfinite(ways), ways, -1.0)))]]
            )
        x, y = self.grid.points_of(cells[[rng.integers(len(cells))]])[0].tolist()
        return Pose2(x, y, float(rng.uniform(-math.pi, math.pi)))

    @cached_property
    def stations(self) -> Tuple[Pose2, ...]:
        """Some places with room, the same each time; ways to them are looked up."""
        rng = np.random.default_rng(0)
        return tuple(self.place(rng) for _ in range(STATIONS))

    def way_between(self, start: int, goal: int) -> np.ndarray:
        """The points (N, 2) of the way from one station to another."""
        if goal not in self._to_stations:
            self._to_stations[goal] = self.distances_to(self.stations[goal])
        if (start, goal) not in self._ways:
            self._ways[start, goal] = self.way(self._to_stations[goal], self.stations[start])
        return self._ways[start, goal]

    def distances_to(self, goal: Pose2) -> np.ndarray:
        """Metres of way to a goal from each cell, float32 (rows, cols), inf where there is none; read only.

        Those to the last goals are kept: many episodes have the same.
        """
        distances = self._to_goals.pop(goal, None)
        if distances is None:
            distances = travel_distances(self.grid, self._room, goal, ROOM_TO_PASS)
            distances.flags.writeable = False
        self._to_goals[goal] = distances
        if len(self._to_goals) > KEPT_GOALS:
            self._to_goals.popitem(last=False)
        return distances

    def distance_at(self, distances: np.ndarray, place: Pose2) -> float:
        """The least of ``distances`` in the cell of a place and around it."""
        row, col = self._cell_of(place)
        window = distances[max(row - 1, 0) : max(row + 2, 0), max(col - 1, 0) : max(col + 2, 0)]
        return float(window.min()) if window.size else math.inf

    def way(self, distances: np.ndarray, start: Pose2, most: int = 1_000_000) -> np.ndarray:
        """The points (N, 2) of a way to the goal that ``distances`` lead to, or the first ``most`` of it."""
        cells = [self._cell_of(start)]
        while distances[cells[-1]] > 0.0 and len(cells) < most:
            row, col = cells[-1]
            around = distances[row - 1 : row + 2, col - 1 : col + 2]
            if around.shape != (3, 3) or not np.isfinite(around).any():
                break
            down, right = np.unravel_index(int(np.argmin(around)), around.shape)
            if (down, right) == (1, 1):
                break
            cells.append((int(row + down - 1), int(col + right - 1)))
        return self.grid.points_of(np.array(cells))

    def _cell_of(self, place: Pose2) -> Tuple[int, int]:
        """Row and column: each period asks for one, for which the grid's arrays would take too long."""
        in_grid = self._map_in_grid @ place
        return math.floor(in_grid.y / self.grid.resolution), math.floor(in_grid.x / self.grid.resolution)
