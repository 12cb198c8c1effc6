"""Local control: a velocity that follows the plan without touching anything.

``local_planner.py`` is the contract, ``registry.py`` the list of those that hold it, ``controller.py`` what
they have in common; each planner has a room of its own.
"""

from move_base_lite.control.controller import Control, Controller
from move_base_lite.control.dwa import DwaSettings, TrajectorySettings
from move_base_lite.control.local_planner import Exploration, LocalPlanner, Plan, Situation, Trajectory
from move_base_lite.control.mppi import MppiSettings
from move_base_lite.control.registry import LOCAL_PLANNERS, check_local_planner
from move_base_lite.control.settings import ControllerSettings

__all__ = [
    "LOCAL_PLANNERS",
    "Control",
    "Controller",
    "ControllerSettings",
    "DwaSettings",
    "Exploration",
    "LocalPlanner",
    "MppiSettings",
    "Plan",
    "Situation",
    "Trajectory",
    "TrajectorySettings",
    "check_local_planner",
]
