"""Where a robot can stand and drive in a world, and path lengths to goals."""

import math
from collections import OrderedDict
from functools import cached_property
from typing import Dict, Optional, Tuple

import numpy as np
from scipy.spatial.distance import cdist

from explorer_lite.travel import travel_distances
from planar import FREE, OccupancyGrid, Pose2
from planar.geometry.distance_field import distance_field

# Minimum distance from the robot's centre to obstacles [m]: at sampled poses, and on paths.
STANDING_CLEARANCE, PASSAGE_CLEARANCE = 0.4, 0.35
WAYPOINT_COUNT = 16
MAX_KEPT_GOALS = 4
NO_BODIES = np.empty((0, 3))


class TraversableSpace:
    """Cells a robot can traverse, and shortest paths over them.

    Args:
        grid: True map of the world.
        start: Pose in the world frame from which sampled poses must be reachable.
        moving_bodies: (N, 3) x, y and radius of moving bodies at the start, which sampled poses avoid.
    """

    def __init__(self, grid: OccupancyGrid, start: Pose2, moving_bodies: np.ndarray = NO_BODIES):
        self.grid = grid
        self._map_in_grid = grid.origin.inverse()
        self._clearance = distance_field(grid.cells != FREE, grid.resolution)
        from_start = travel_distances(grid, self._clearance, start, PASSAGE_CLEARANCE)
        self._goal_distances: OrderedDict[Pose2, np.ndarray] = OrderedDict()
        self._waypoint_distances: Dict[int, np.ndarray] = {}
        self._paths: Dict[Tuple[int, int], np.ndarray] = {}
        standing_cells = np.argwhere((self._clearance > STANDING_CLEARANCE) & np.isfinite(from_start))
        gaps = cdist(grid.points_of(standing_cells), moving_bodies[:, :2]) - moving_bodies[:, 2]
        self._standing_cells = standing_cells[(gaps > STANDING_CLEARANCE).all(axis=1)]

    def sample_pose(
        self, rng: np.random.Generator, distances: Optional[np.ndarray] = None, min_length: float = 0.0
    ) -> Pose2:
        """Sample a random free pose.

        Args:
            rng: Source of random numbers.
            distances: Path lengths to a goal, as of ``distances_to``.
            min_length: Minimum path length to that goal [m]; the farthest pose if none is that far.
        """
        cells = self._standing_cells
        if distances is not None:
            path_lengths = distances[cells[:, 0], cells[:, 1]]
            far = np.isfinite(path_lengths) & (path_lengths >= min_length)
            cells = (
                cells[far]
                if far.any()
                else cells[[int(np.argmax(np.where(np.isfinite(path_lengths), path_lengths, -1.0)))]]
            )
        x, y = self.grid.points_of(cells[[rng.integers(len(cells))]])[0].tolist()
        return Pose2(x, y, float(rng.uniform(-math.pi, math.pi)))

    @cached_property
    def waypoints(self) -> Tuple[Pose2, ...]:
        """Fixed random poses; paths between them are cached."""
        rng = np.random.default_rng(0)
        return tuple(self.sample_pose(rng) for _ in range(WAYPOINT_COUNT))

    def path_between(self, start: int, goal: int) -> np.ndarray:
        """Return the points (N, 2) of the shortest path between two waypoints, by their indices."""
        if goal not in self._waypoint_distances:
            self._waypoint_distances[goal] = self.distances_to(self.waypoints[goal])
        if (start, goal) not in self._paths:
            self._paths[start, goal] = self.path(self._waypoint_distances[goal], self.waypoints[start])
        return self._paths[start, goal]

    def distances_to(self, goal: Pose2) -> np.ndarray:
        """Return path lengths to a goal [m], float32 (rows, cols), inf without a path; read-only.

        Those of the last goals are cached, because many episodes have the same goal.
        """
        distances = self._goal_distances.pop(goal, None)
        if distances is None:
            distances = travel_distances(self.grid, self._clearance, goal, PASSAGE_CLEARANCE)
            distances.flags.writeable = False
        self._goal_distances[goal] = distances
        if len(self._goal_distances) > MAX_KEPT_GOALS:
            self._goal_distances.popitem(last=False)
        return distances

    def distance_at(self, distances: np.ndarray, place: Pose2) -> float:
        """Return the smallest of ``distances`` in the cell of a pose and its neighbours."""
        row, col = self._cell_of(place)
        window = distances[max(row - 1, 0) : max(row + 2, 0), max(col - 1, 0) : max(col + 2, 0)]
        return float(window.min()) if window.size else math.inf

    def path(self, distances: np.ndarray, start: Pose2, most: int = 1_000_000) -> np.ndarray:
        """Return the first ``most`` points (N, 2) of the path that descends ``distances`` from ``start``."""
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
        """Row and column of a pose; faster than the grid's array functions."""
        in_grid = self._map_in_grid @ place
        return math.floor(in_grid.y / self.grid.resolution), math.floor(in_grid.x / self.grid.resolution)


class DistanceToGoal:
    """Remaining path length from the robot to a goal.

    Args:
        space: Traversable space of the world.
        goal: Goal pose in the world frame.
        start: Robot pose in the world frame at the start.
    """

    def __init__(self, space: TraversableSpace, goal: Pose2, start: Pose2):
        self.goal = goal
        self._space = space
        self._distances = space.distances_to(goal)
        self._remaining = space.distance_at(self._distances, start)

    def waypoint(self, base: Pose2, lookahead: float) -> np.ndarray:
        """Return the point (2,) ``lookahead`` metres along the shortest path, in the robot's frame."""
        count = round(lookahead / self._space.grid.resolution) + 1
        path_xy = self._space.path(self._distances, base, count)
        return base.inverse().transform_points(path_xy[-1:])[0]

    def decrease(self, base: Pose2) -> float:
        """Return by how much the distance has decreased since the last call [m]; 0 where no path is known."""
        remaining = self._space.distance_at(self._distances, base)
        if not math.isfinite(remaining):
            return 0.0
        before, self._remaining = self._remaining, remaining
        return before - remaining if math.isfinite(before) else 0.0
