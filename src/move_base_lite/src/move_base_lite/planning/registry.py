"""The global planners that there are. To add one is to add it here."""

from move_base_lite.planning.global_planner import GlobalPlanner, PlannerSettings
from move_base_lite.planning.guarded import GuardedGlobalPlanner
from move_base_lite.planning.navfn import GLOBAL_PLANNER, NAVFN
from move_base_lite.plugin import Registry
from planar.plugins import PluginContract

GLOBAL_PLANNERS: Registry[GlobalPlanner] = Registry(
    NAVFN,
    GLOBAL_PLANNER,
    contract=PluginContract(
        "global planner", GlobalPlanner, PlannerSettings, "move_base_lite.global_planners"
    ),
    guarded=GuardedGlobalPlanner,
)
