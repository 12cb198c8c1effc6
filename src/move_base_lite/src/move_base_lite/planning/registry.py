"""Registry of the global planners."""

from move_base_lite.planning.global_planner import CONTRACT, GlobalPlanner
from move_base_lite.planning.navfn import GLOBAL_PLANNER, NAVFN
from planar.extensions import Registry

GLOBAL_PLANNERS: Registry[GlobalPlanner] = Registry(CONTRACT, NAVFN, GLOBAL_PLANNER)
