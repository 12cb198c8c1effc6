"""Local control: velocity commands that follow the plan without a collision.

``local_planner.py`` is the contract of local planners, ``registry.py`` their registry, ``controller.py`` what
all of them share; each planner has a package of its name.
"""

from move_base_lite.control.controller import Controller, ControlOutput
from move_base_lite.control.dwa import DwaSettings, TrajectorySettings
from move_base_lite.control.local_planner import (
    ControlContext,
    LocalPlanner,
    Plan,
    Trajectory,
    TrajectorySamples,
)
from move_base_lite.control.mppi import MppiSettings
from move_base_lite.control.registry import LOCAL_PLANNERS, check_local_planner
from move_base_lite.control.settings import ControllerSettings
from planar.deprecation import deprecated_names

__all__ = [
    "LOCAL_PLANNERS",
    "ControlContext",
    "ControlOutput",
    "Controller",
    "ControllerSettings",
    "DwaSettings",
    "LocalPlanner",
    "MppiSettings",
    "Plan",
    "Trajectory",
    "TrajectorySamples",
    "TrajectorySettings",
    "check_local_planner",
]

__getattr__ = deprecated_names(
    __name__,
    {"Situation": "ControlContext", "Exploration": "TrajectorySamples", "Control": "ControlOutput"},
)
