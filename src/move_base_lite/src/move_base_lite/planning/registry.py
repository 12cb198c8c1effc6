"""The global planners that there are. To add one is to add it here."""

from move_base_lite.planning.global_planner import GlobalPlanner
from move_base_lite.planning.navfn import GLOBAL_PLANNER, NAVFN
from move_base_lite.plugin import Registry

GLOBAL_PLANNERS: Registry[GlobalPlanner] = Registry(
    NAVFN,
    GLOBAL_PLANNER,
)
