"""Stands before a global planner of other people: what it gives is checked, what it raises is its fault."""

from typing import Callable, Optional, Tuple

import numpy as np

from move_base_lite.costmap import CostmapWindow
from move_base_lite.errors import PlanningPluginFailed
from move_base_lite.planning.global_planner import GlobalPlanner, Potential
from move_base_lite.plugin_guard import PluginGuard


class GuardedGlobalPlanner:
    """A GlobalPlanner; see there."""

    def __init__(self, name: str, make: Callable[[], GlobalPlanner]):
        self._guard = PluginGuard(name, make, PlanningPluginFailed)
        self.potential: Optional[Potential] = None

    def plan(
        self,
        costs: np.ndarray,
        window: CostmapWindow,
        start_xy: Tuple[float, float],
        goal_xy: Tuple[float, float],
        tolerance: float = 0.0,
    ) -> np.ndarray:
        with self._guard.watch(costs) as planner:
            path_xy = np.asarray(planner.plan(costs, window, start_xy, goal_xy, tolerance), float)
            self.potential = getattr(planner, "potential", None)
        if not (path_xy.ndim == 2 and path_xy.shape[1:] == (2,) and len(path_xy) > 1):
            raise self._guard.fail(f"gave a path of the shape {path_xy.shape}, not (N, 2) with N > 1")
        if not np.isfinite(path_xy).all():
            raise self._guard.fail("gave a path that is not finite")
        return path_xy
