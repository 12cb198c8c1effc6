"""TITLE: a global planner for move_base_lite."""

from dataclasses import dataclass
from typing import Tuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from move_base_lite import CostmapWindow, GoalBlocked, NoPath, OutOfMap, PlannerSettings
from planar.config.parameters import at_least, parameter

# Cost from which on the robot is in collision (INSCRIBED).
BLOCKED = 253
STEPS = ((0, 1), (1, 0), (1, 1), (1, -1))


@dataclass(frozen=True)
class Settings(PlannerSettings):
    """Parameters in addition to those of every global planner, read from the namespace CLASS."""

    caution: float = parameter(
        3.0, "weight of the costs: higher values keep farther from obstacles", "", at_least(0.0)
    )


class CLASS:
    """Dijkstra's algorithm on the cells and their eight neighbours."""

    Settings = Settings
    potential = None

    def __init__(self, settings: Settings):
        self._settings = settings

    def plan(
        self,
        costs: np.ndarray,
        window: CostmapWindow,
        start_xy: Tuple[float, float],
        goal_xy: Tuple[float, float],
        tolerance: float = 0.0,
    ) -> np.ndarray:
        """See move_base_lite.GlobalPlanner; raises OutOfMap, StartBlocked, GoalBlocked or NoPath."""
        if not (window.contains(*start_xy) and window.contains(*goal_xy)):
            raise OutOfMap(f"{start_xy} or {goal_xy} is outside of the map")
        start, goal = (np.ravel_multi_index(window.cell_of(*xy), costs.shape) for xy in (start_xy, goal_xy))
        if costs.flat[goal] >= BLOCKED:
            raise GoalBlocked(f"{goal_xy} is blocked")
        _, before = dijkstra(self._graph(costs), directed=False, indices=start, return_predecessors=True)
        cells = [goal]
        while before[cells[-1]] >= 0:
            cells.append(before[cells[-1]])
        if cells[-1] != start:
            raise NoPath(f"no path from {start_xy} to {goal_xy}")
        rows, cols = np.unravel_index(cells[::-1], costs.shape)
        centres_xy = np.column_stack((cols, rows)) * window.resolution + 0.5 * window.resolution
        path_xy = centres_xy + (window.origin_x, window.origin_y)
        return np.vstack([start_xy, path_xy[1:-1], goal_xy])

    def _graph(self, costs: np.ndarray) -> coo_matrix:
        """Distances between neighbouring free cells, weighted by their costs."""
        number, free = np.arange(costs.size).reshape(costs.shape), costs < BLOCKED
        weight = 1.0 + self._settings.caution * costs / 255.0
        ends = []
        for rows, cols in STEPS:
            one = np.s_[: costs.shape[0] - rows, max(-cols, 0) : costs.shape[1] - max(cols, 0)]
            other = np.s_[rows:, max(cols, 0) : costs.shape[1] + min(cols, 0)]
            is_free = free[one] & free[other]
            length = np.hypot(rows, cols) * 0.5 * (weight[one] + weight[other])
            ends.append((number[one][is_free], number[other][is_free], length[is_free]))
        first, second, lengths = map(np.concatenate, zip(*ends))
        return coo_matrix((lengths, (first, second)), shape=(costs.size, costs.size))
