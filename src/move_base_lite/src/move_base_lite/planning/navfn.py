"""navfn and global_planner: a wavefront from the robot and gradient descent from the goal."""

from dataclasses import dataclass
from typing import Any, Dict, Optional, Tuple

import numpy as np

from move_base_lite.costmap import INSCRIBED, LETHAL, UNKNOWN, CostmapWindow
from move_base_lite.errors import GoalBlocked, NoPath, OutOfMap, StartBlocked
from move_base_lite.planning.global_planner import (
    ORIENTATIONS,
    GlobalPlanner,
    PlannerSettings,
    PlanRequest,
    Potential,
)
from move_base_lite.planning.nearest import Cell, passable_ends
from move_base_lite.planning.shortcuts import shorten
from move_base_lite.planning.wavefront import propagate_wavefront, trace_path, traversal_costs
from planar.config.parameters import Interval, at_least, parameter
from planar.config.settings import check
from planar.config.without_effect import IneffectiveParameter
from planar.extensions import Plugin

STEP_CELLS = 0.5
# Maximum length of a shortcut [cells]: practically unlimited, or just smoothing of the gradient's steps.
ANY_ANGLE, SMOOTH = 200.0, 3.0
START_TOLERANCE = 0.5


@dataclass(frozen=True)
class NavfnSettings(PlannerSettings):
    """navfn's parameters and additional ones; entering a cell costs neutral_cost + cost_factor * cost."""

    use_astar: bool = parameter(False, "A* instead of Dijkstra's algorithm")
    use_grid_path: bool = parameter(False, "follow cells instead of the gradient")
    any_angle: bool = parameter(False, "straight lines where they cost no more")
    neutral_cost: int = parameter(50, "cost of entering a free cell")
    cost_factor: float = parameter(
        0.8, "factor of a cell's cost that is added; GlobalPlanner: 3.0", bounds=at_least(0.0)
    )
    lethal_cost: int = parameter(
        253, "cost from which on a cell is impassable", bounds=Interval(high=253, words="at most 253")
    )

    def __post_init__(self):
        super().__post_init__()
        check(
            1 <= self.neutral_cost < self.lethal_cost, "neutral_cost", "1 to lethal_cost", self.neutral_cost
        )


@dataclass(frozen=True)
class GlobalPlannerSettings(NavfnSettings):
    """Parameters of global_planner, with its names, defaults and dynamic parameters."""

    lethal_cost: int = parameter(
        253,
        "cost from which on a cell is impassable",
        bounds=Interval(high=253, words="at most 253"),
        dynamic=(1, 255),
    )
    neutral_cost: int = parameter(50, "cost of entering a free cell", dynamic=(1, 255))
    cost_factor: float = parameter(
        3.0, "factor of a cell's cost that is added", bounds=at_least(0.0), dynamic=(0.01, 5.0)
    )
    visualize_potential: bool = parameter(
        True, "publish the potential of each plan", name="publish_potential", dynamic=True
    )
    orientation_mode: int = parameter(1, ORIENTATIONS, bounds=Interval(0, 6, "0 to 6"), dynamic=(0, 6))


class Navfn:
    """A GlobalPlanner with navfn's costs and wavefront.

    Args:
        settings: Parameters of navfn or global_planner.
    """

    def __init__(self, settings: NavfnSettings):
        self._settings = settings
        self.potential: Optional[Potential] = None

    def plan(self, request: PlanRequest) -> np.ndarray:
        """Plan a path (see GlobalPlanner.plan).

        A blocked start or goal is replaced by a cell that is connected to the other one, if possible.
        """
        settings, costs, window = self._settings, request.costs, request.window
        start_xy, goal_xy = request.start_xy, request.goal_xy
        traversal = traversal_costs(
            costs, settings.allow_unknown, settings.neutral_cost, settings.cost_factor, settings.lethal_cost
        )
        start = _cell_in_map(window, start_xy, "robot")
        goal = _cell_in_map(window, goal_xy, "goal")
        tolerance_cells = max(request.tolerance, settings.default_tolerance) / window.resolution
        start_cells = START_TOLERANCE / window.resolution
        free_start, free_goal = passable_ends(traversal, start, goal, start_cells, tolerance_cells)
        if free_start is None:
            raise StartBlocked(f"{_named('robot', start_xy)} is {_why(int(costs[start]))}")
        if free_goal is None:
            raise GoalBlocked(f"{_named('goal', goal_xy)} is {_why(int(costs[goal]))}")
        if free_start == free_goal:
            return np.array([start_xy, goal_xy if free_goal == goal else _centre(window, free_goal)])
        path_cells = self._path_cells(traversal, window, free_start, free_goal)
        if not len(path_cells):
            raise NoPath(f"no path leads from {_named('robot', start_xy)} to {_named('goal', goal_xy)}")
        path_xy = path_cells * window.resolution + (window.origin_x, window.origin_y)
        ends = [np.array([start_xy]), path_xy[1:-1] if free_start == start else path_xy[:-1]]
        ends.append(np.array([goal_xy]) if free_goal == goal else path_xy[-1:])
        return np.concatenate(ends)

    def _path_cells(
        self, traversal: np.ndarray, window: CostmapWindow, start: Cell, goal: Cell
    ) -> np.ndarray:
        """The path (N, 2) of col, row, empty if there is none; keeps the potential for visualization."""
        settings = self._settings
        potential = propagate_wavefront(traversal, *start, *goal, settings.use_astar)
        if settings.visualize_potential:
            self.potential = Potential(potential, window, float(potential[goal]))
        path_cells = trace_path(potential, *start, *goal, 0.0 if settings.use_grid_path else STEP_CELLS)
        if len(path_cells) and not settings.use_grid_path:
            return shorten(traversal, path_cells, ANY_ANGLE if settings.any_angle else SMOOTH)
        return path_cells


def _cell_in_map(window: CostmapWindow, point_xy: Tuple[float, float], what: str) -> Cell:
    if not window.contains(*point_xy):
        raise OutOfMap(f"{_named(what, point_xy)} is outside the map")
    return window.cell_of(*point_xy)


def _named(what: str, point_xy: Tuple[float, float]) -> str:
    return f"the {what} at ({point_xy[0]:.2f}, {point_xy[1]:.2f})"


def _why(cost: int) -> str:
    if cost == UNKNOWN:
        return "in unknown space"
    if cost == LETHAL:
        return "in an obstacle"
    return "too close to an obstacle" if cost == INSCRIBED else "on the edge of the map"


def _centre(window: CostmapWindow, cell: Tuple[int, int]) -> Tuple[float, float]:
    row, col = cell
    return (
        window.origin_x + (col + 0.5) * window.resolution,
        window.origin_y + (row + 0.5) * window.resolution,
    )


def _with_astar(values: Dict[str, Any]) -> Dict[str, Any]:
    """Translate global_planner's ``use_dijkstra`` to ``use_astar``."""
    if "use_dijkstra" not in values:
        return values
    return {
        **{name: value for name, value in values.items() if name != "use_dijkstra"},
        "use_astar": not values["use_dijkstra"],
    }


UNUSED = "the official planner does not use it either"
WINDOW = (
    IneffectiveParameter("planner_window_x", 0.0, UNUSED, is_dynamic=False),
    IneffectiveParameter("planner_window_y", 0.0, UNUSED, is_dynamic=False),
)
GRADIENT = (
    IneffectiveParameter("old_navfn_behavior", False, "paths have one form", is_dynamic=False),
    IneffectiveParameter("use_quadratic", True, "potentials are quadratic", is_dynamic=False),
)
BORDER = IneffectiveParameter("outline_map", True, "the border of the map is always impassable")
WINDOW_SIZE = IneffectiveParameter(
    "orientation_window_size", 1, "headings are those of the path's segments", 1, 255
)
NAVFN: Plugin[GlobalPlanner] = Plugin(
    "navfn/NavfnROS",
    NavfnSettings,
    Navfn,
    translate=_with_astar,
    without_effect=WINDOW,
)
GLOBAL_PLANNER: Plugin[GlobalPlanner] = Plugin(
    "global_planner/GlobalPlanner",
    GlobalPlannerSettings,
    Navfn,
    translate=_with_astar,
    without_effect=(WINDOW_SIZE, BORDER, *WINDOW, *GRADIENT),
)
