"""Global planning: paths through a costmap.

``global_planner.py`` is the contract of global planners, GLOBAL_PLANNERS their registry.
"""

from move_base_lite.planning.global_planner import (
    CONTRACT,
    GlobalPlanner,
    PlannerSettings,
    PlanRequest,
    Potential,
)
from move_base_lite.planning.navfn import GLOBAL_PLANNER, NAVFN, GlobalPlannerSettings, Navfn, NavfnSettings
from move_base_lite.planning.paths import headings_along, path_cost
from planar.extensions import Registry

GLOBAL_PLANNERS: Registry[GlobalPlanner] = Registry(CONTRACT, NAVFN, GLOBAL_PLANNER)

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
