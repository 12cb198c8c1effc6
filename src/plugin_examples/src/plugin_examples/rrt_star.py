"""RRT* (Karaman and Frazzoli, 2011): a tree of random points, rewired towards shorter paths."""

from dataclasses import dataclass
from typing import Optional, Tuple

import numba
import numpy as np

from move_base_lite import (
    CostmapWindow,
    GoalBlocked,
    NoPath,
    OutOfMap,
    PlannerSettings,
    PlanRequest,
    StartBlocked,
)
from move_base_lite.costmap import INSCRIBED
from planar.config.parameters import POSITIVE, Interval, parameter


@dataclass(frozen=True)
class RrtStarSettings(PlannerSettings):
    """Number, reach and seed of the samples."""

    samples: int = parameter(6000, "number of samples", bounds=Interval(10, 100000, "10 to 100000"))
    steer: float = parameter(1.0, "maximum length of a branch", "m", POSITIVE)
    goal_bias: float = parameter(0.05, "share of samples at the goal", bounds=Interval(0.0, 1.0, "0 to 1"))
    seed: int = parameter(0, "of the random samples")


class RrtStar:
    """Global planner that searches a path with a random tree (RRT*).

    Args:
        settings: Number, reach and seed of the samples.
    """

    Settings = RrtStarSettings
    potential = None

    def __init__(self, settings: RrtStarSettings):
        self._settings = settings

    def plan(self, request: PlanRequest) -> np.ndarray:
        """Find a path between two points.

        Args:
            request: Global costmap, start and goal; the tolerance is not used, as the path ends at the goal.

        Returns:
            Points (N, 2) of the path, at most one cell apart [m].

        Raises:
            StartBlocked: The start is not free.
            GoalBlocked: The goal is not free.
            OutOfMap: The start or the goal is outside of the map.
            NoPath: The samples connect no path.
        """
        costs, window = request.costs, request.window
        start_xy, goal_xy = request.start_xy, request.goal_xy
        is_free = (costs < INSCRIBED) | (self._settings.allow_unknown & (costs == 255))
        start, goal = (self._cell(xy, window) for xy in (start_xy, goal_xy))
        for cell, kind in ((start, StartBlocked), (goal, GoalBlocked)):
            if not is_free[int(cell[0]), int(cell[1])]:
                raise kind(f"({cell[1]:g}, {cell[0]:g}) is blocked")
        path_cells = self._find_path(is_free, np.array(start), np.array(goal), window.resolution)
        if path_cells is None:
            raise NoPath(f"{self._settings.samples} samples found no path to {goal_xy}")
        corners_xy = (path_cells[:, ::-1]) * window.resolution + (window.origin_x, window.origin_y)
        corners_xy[0], corners_xy[-1] = start_xy, goal_xy
        return _in_small_steps(corners_xy, window.resolution)

    def _find_path(
        self, is_free: np.ndarray, start: np.ndarray, goal: np.ndarray, resolution: float
    ) -> Optional[np.ndarray]:
        settings = self._settings
        draws = np.random.default_rng(settings.seed).random((settings.samples, 2)) * is_free.shape
        draws[:: max(int(1.0 / max(settings.goal_bias, 1e-6)), 1)] = goal
        nodes, parents, end = _grow(is_free, start, goal, draws, settings.steer / resolution)
        if end < 0:
            return None
        indices = [end]
        while parents[indices[-1]] >= 0:
            indices.append(parents[indices[-1]])
        return np.vstack([nodes[indices[::-1]], goal])

    def _cell(self, xy: Tuple[float, float], window: CostmapWindow) -> Tuple[float, float]:
        """Row and column as fractional cells."""
        if not window.contains(*xy):
            raise OutOfMap(f"({xy[0]:g}, {xy[1]:g}) is outside of the map")
        return (xy[1] - window.origin_y) / window.resolution, (xy[0] - window.origin_x) / window.resolution


def _in_small_steps(corners_xy: np.ndarray, step: float) -> np.ndarray:
    pieces = [corners_xy[:1]]
    for first, second in zip(corners_xy[:-1], corners_xy[1:]):
        count = max(int(np.ceil(np.hypot(*(second - first)) / step)), 1)
        pieces.append(first + (second - first) * np.linspace(0.0, 1.0, count + 1)[1:, None])
    return np.vstack(pieces)


@numba.njit(cache=True)
def _is_clear(is_free, first, second):
    length = np.hypot(second[0] - first[0], second[1] - first[1])
    steps = int(length * 2.0) + 1
    for number in range(steps + 1):
        share = number / steps
        row = first[0] + (second[0] - first[0]) * share
        col = first[1] + (second[1] - first[1]) * share
        if not is_free[int(row), int(col)]:
            return False
    return True


@numba.njit(cache=True)
def _grow(is_free, start, goal, draws, reach):
    """Nodes (N, 2), their parents, and the last node of the shortest path to the goal, or -1."""
    nodes = np.empty((len(draws) + 1, 2))
    parents = np.full(len(draws) + 1, -1)
    lengths = np.zeros(len(draws) + 1)
    nodes[0], count = start, 1
    for draw in draws:
        apart = np.hypot(nodes[:count, 0] - draw[0], nodes[:count, 1] - draw[1])
        nearest = np.argmin(apart)
        share = min(reach / max(apart[nearest], 1e-9), 1.0)
        new = nodes[nearest] + (draw - nodes[nearest]) * share
        if apart[nearest] < 1e-9 or not _is_clear(is_free, nodes[nearest], new):
            continue
        around = np.hypot(nodes[:count, 0] - new[0], nodes[:count, 1] - new[1])
        parent, length = nearest, lengths[nearest] + around[nearest]
        near = np.flatnonzero(around <= reach)
        for other in near:
            if lengths[other] + around[other] < length and _is_clear(is_free, nodes[other], new):
                parent, length = other, lengths[other] + around[other]
        nodes[count], parents[count], lengths[count] = new, parent, length
        for other in near:
            if length + around[other] < lengths[other] and _is_clear(is_free, new, nodes[other]):
                parents[other], lengths[other] = count, length + around[other]
        count += 1
    best, shortest = -1, np.inf
    to_goal = np.hypot(nodes[:count, 0] - goal[0], nodes[:count, 1] - goal[1])
    for node in np.flatnonzero(to_goal <= reach):
        if lengths[node] + to_goal[node] < shortest and _is_clear(is_free, nodes[node], goal):
            best, shortest = node, lengths[node] + to_goal[node]
    return nodes[:count], parents[:count], best
