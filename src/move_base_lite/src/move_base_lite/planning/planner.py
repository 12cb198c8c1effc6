"""The global planner: navfn's costs, a wavefront from the robot, a path down its gradient from the goal."""

import math
from dataclasses import dataclass
from typing import Optional, Tuple

import numpy as np

from move_base_lite.costmap import INSCRIBED, LETHAL, UNKNOWN, Window
from move_base_lite.errors import GoalBlocked, NoPath, OutOfMap, StartBlocked
from move_base_lite.planning.nearest import passable_ends
from move_base_lite.planning.shortcuts import shortened
from move_base_lite.planning.wavefront import FACTOR, NEUTRAL, descend, spread, traversal_costs
from planar.config.settings import check

STEP_CELLS = 0.5
# Cells that a shortcut may span: any number at any angle; otherwise what evens out the steps of the gradient.
ANY_ANGLE, SMOOTH = 200.0, 3.0
START_TOLERANCE = 0.5


@dataclass(frozen=True)
class PlannerSettings:
    """``default_tolerance``: metres from a blocked goal within which another one will do.

    ``neutral_cost``, ``cost_factor``: entering a cell costs neutral + factor * cost; ``lethal_cost``: from
    which cost on it cannot be entered. ``use_grid_path``: from cell to cell instead of down the gradient.
    ``any_angle``: with straight lines where they cost no more, unlike navfn.
    ``orientation_mode``: which way the robot is to look on the way (see headings_along).
    ``visualize_potential``: whether the wave of a plan is shown, as a grid of at most ``publish_scale``.
    """

    allow_unknown: bool = True
    default_tolerance: float = 0.0
    use_astar: bool = False
    use_grid_path: bool = False
    any_angle: bool = False
    neutral_cost: int = 50
    cost_factor: float = 0.8
    lethal_cost: int = 253
    orientation_mode: int = 0
    visualize_potential: bool = False
    publish_scale: int = 100

    def __post_init__(self):
        check(
            1 <= self.neutral_cost < self.lethal_cost, "neutral_cost", "1 to lethal_cost", self.neutral_cost
        )
        check(self.lethal_cost <= 253, "lethal_cost", "at most 253", self.lethal_cost)
        check(self.cost_factor >= 0.0, "cost_factor", "at least 0", self.cost_factor)
        check(0 <= self.orientation_mode <= 6, "orientation_mode", "0 to 6", self.orientation_mode)
        check(1 <= self.publish_scale <= 127, "publish_scale", "1 to 127", self.publish_scale)
        check(self.default_tolerance >= 0.0, "default_tolerance", "at least 0", self.default_tolerance)


@dataclass(frozen=True, eq=False)
class Potential:
    """The wave of a plan: cost from the robot, float32 (rows, cols), inf where it has not come to.

    ``at_goal``: its value there.
    """

    values: np.ndarray
    window: Window
    at_goal: float


class GlobalPlanner:
    """Plans on costs given with their window; holds no costmap of its own.

    ``potential``: the wave of the newest plan, found or not, if the settings ask for it.
    """

    def __init__(self, settings: PlannerSettings):
        self._settings = settings
        self.potential: Optional[Potential] = None

    def plan(
        self,
        costs: np.ndarray,
        window: Window,
        start_xy: Tuple[float, float],
        goal_xy: Tuple[float, float],
        tolerance: float = 0.0,
    ) -> np.ndarray:
        """Path (N, 2), metres in the window's frame, from start to goal or near it.

        A goal that cannot be stood on gives way to the nearest free place within ``tolerance`` (or the
        default one if that is larger); a start, to one within half a metre: of those from which the other end
        can be reached, if any can.
        Raises OutOfMap, StartBlocked, GoalBlocked or NoPath.
        """
        settings = self._settings
        traversal = traversal_costs(
            costs, settings.allow_unknown, settings.neutral_cost, settings.cost_factor, settings.lethal_cost
        )
        start = self._cell_in_map(window, start_xy, "robot")
        goal = self._cell_in_map(window, goal_xy, "goal")
        tolerance_cells = max(tolerance, self._settings.default_tolerance) / window.resolution
        start_cells = START_TOLERANCE / window.resolution
        free_start, free_goal = passable_ends(traversal, start, goal, start_cells, tolerance_cells)
        if free_start is None:
            raise StartBlocked(f"{_named('robot', start_xy)} is {_why(costs[start])}")
        if free_goal is None:
            raise GoalBlocked(f"{_named('goal', goal_xy)} is {_why(costs[goal])}")
        if free_start == free_goal:
            return np.array([start_xy, goal_xy if free_goal == goal else _centre(window, free_goal)])
        potential = spread(traversal, *free_start, *free_goal, settings.use_astar)
        if settings.visualize_potential:
            self.potential = Potential(potential, window, float(potential[free_goal]))
        path_cells = descend(
            potential, *free_start, *free_goal, 0.0 if settings.use_grid_path else STEP_CELLS
        )
        if not len(path_cells):
            raise NoPath(f"no way leads from {_named('robot', start_xy)} to {_named('goal', goal_xy)}")
        if not settings.use_grid_path:
            path_cells = shortened(traversal, path_cells, ANY_ANGLE if settings.any_angle else SMOOTH)
        path_xy = path_cells * window.resolution + (window.origin_x, window.origin_y)
        ends = [np.array([start_xy]), path_xy[1:-1] if free_start == start else path_xy[:-1]]
        ends.append(np.array([goal_xy]) if free_goal == goal else path_xy[-1:])
        return np.concatenate(ends)

    @staticmethod
    def _cell_in_map(window: Window, point_xy: Tuple[float, float], what: str) -> Tuple[int, int]:
        if not window.contains(*point_xy):
            raise OutOfMap(f"{_named(what, point_xy)} is outside the map")
        return window.cell_of(*point_xy)


def path_cost(costs: np.ndarray, window: Window, path_xy: np.ndarray) -> float:
    """What navfn would pay for a path (N, 2), in neutral metres; inf where it cannot be driven."""
    cells = np.floor((path_xy - (window.origin_x, window.origin_y)) / window.resolution).astype(np.int64)
    below = costs[cells[1:, 1], cells[1:, 0]].astype(float)
    if (below >= INSCRIBED).any():
        return math.inf
    lengths = np.linalg.norm(np.diff(path_xy, axis=0), axis=1)
    return float((lengths * (1.0 + FACTOR / NEUTRAL * below)).sum())


def _named(what: str, point_xy: Tuple[float, float]) -> str:
    return f"the {what} at ({point_xy[0]:.2f}, {point_xy[1]:.2f})"


def _why(cost: int) -> str:
    if cost == UNKNOWN:
        return "in unknown space"
    if cost == LETHAL:
        return "in an obstacle"
    return "too close to an obstacle" if cost == INSCRIBED else "on the edge of the map"


def _centre(window: Window, cell: Tuple[int, int]) -> Tuple[float, float]:
    row, col = cell
    return (
        window.origin_x + (col + 0.5) * window.resolution,
        window.origin_y + (row + 0.5) * window.resolution,
    )
