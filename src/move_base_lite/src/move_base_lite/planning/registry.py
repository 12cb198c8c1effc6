"""Registry of the global planners, and the guard that checks custom ones."""

from typing import Callable, Optional, Tuple

import numpy as np

from move_base_lite.costmap import CostmapWindow
from move_base_lite.errors import PlanningPluginFailed
from move_base_lite.planning.global_planner import GlobalPlanner, PlannerSettings, Potential
from move_base_lite.planning.navfn import GLOBAL_PLANNER, NAVFN
from move_base_lite.plugin import Registry
from move_base_lite.plugin_guard import PluginGuard
from planar.plugins import PluginContract


class GuardedGlobalPlanner:
    """A GlobalPlanner that wraps a custom one.

    Args:
        name: Name of the plugin, for messages.
        make: Constructs the wrapped planner.
    """

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
        """Call the wrapped planner (see GlobalPlanner.plan).

        Raises:
            PlanningPluginFailed: The planner raised, took too long, modified the costs or returned an invalid
                path.
        """
        with self._guard.watch(costs) as planner:
            path_xy = np.asarray(planner.plan(costs, window, start_xy, goal_xy, tolerance), float)
            self.potential = getattr(planner, "potential", None)
        if not (path_xy.ndim == 2 and path_xy.shape[1:] == (2,) and len(path_xy) > 1):
            raise self._guard.fail(f"gave a path of the shape {path_xy.shape}, not (N, 2) with N > 1")
        if not np.isfinite(path_xy).all():
            raise self._guard.fail("gave a path that is not finite")
        return path_xy


GLOBAL_PLANNERS: Registry[GlobalPlanner] = Registry(
    NAVFN,
    GLOBAL_PLANNER,
    contract=PluginContract(
        "global planner", GlobalPlanner, PlannerSettings, "move_base_lite.global_planners"
    ),
    guarded=GuardedGlobalPlanner,
)
