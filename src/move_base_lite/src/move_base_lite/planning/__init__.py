"""Global planning: a way through a costmap.

``global_planner.py`` is the contract, ``registry.py`` the list of those that hold it.
"""

from move_base_lite.planning.global_planner import GlobalPlanner, PlannerSettings, Potential
from move_base_lite.planning.headings import headings_along
from move_base_lite.planning.navfn import GlobalPlannerSettings, Navfn, NavfnSettings
from move_base_lite.planning.path_cost import path_cost
from move_base_lite.planning.registry import GLOBAL_PLANNERS

__all__ = [
    "GLOBAL_PLANNERS",
    "GlobalPlanner",
    "GlobalPlannerSettings",
    "Navfn",
    "NavfnSettings",
    "PlannerSettings",
    "Potential",
    "headings_along",
    "path_cost",
]
