"""Global planning: paths through a costmap.

``global_planner.py`` is the contract of global planners, ``registry.py`` their registry.
"""

from move_base_lite.planning.global_planner import GlobalPlanner, PlannerSettings, PlanRequest, Potential
from move_base_lite.planning.navfn import GlobalPlannerSettings, Navfn, NavfnSettings
from move_base_lite.planning.paths import headings_along, path_cost
from move_base_lite.planning.registry import GLOBAL_PLANNERS

__all__ = [
    "GLOBAL_PLANNERS",
    "GlobalPlanner",
    "GlobalPlannerSettings",
    "Navfn",
    "NavfnSettings",
    "PlanRequest",
    "PlannerSettings",
    "Potential",
    "headings_along",
    "path_cost",
]
