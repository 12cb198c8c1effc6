"""The local planners that there are. To add one is to add it here."""

from move_base_lite.control.dwa import DWA, TRAJECTORY
from move_base_lite.control.guarded import GuardedLocalPlanner
from move_base_lite.control.local_planner import LocalPlanner
from move_base_lite.control.mppi import MPPI
from move_base_lite.control.settings import ControllerSettings
from move_base_lite.plugin import Registry
from planar.plugins import Contract

LOCAL_PLANNERS: Registry[LocalPlanner] = Registry(
    TRAJECTORY,
    DWA,
    MPPI,
    contract=Contract("local planner", LocalPlanner, ControllerSettings, "move_base_lite.local_planners"),
    guarded=GuardedLocalPlanner,
)
