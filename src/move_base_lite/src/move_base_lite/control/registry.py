"""The local planners that there are. To add one is to add it here."""

from move_base_lite.control.dwa import DWA, TRAJECTORY
from move_base_lite.control.local_planner import LocalPlanner
from move_base_lite.control.mppi import MPPI
from move_base_lite.plugin import Registry

LOCAL_PLANNERS: Registry[LocalPlanner] = Registry(
    TRAJECTORY,
    DWA,
    MPPI,
)
