"""Navigation after move_base: from a goal, poses and scans to velocities that reach it without collision."""

from move_base_lite.config import NavigatorSettings
from move_base_lite.errors import (
    ControlError,
    GoalBlocked,
    NavigationError,
    NoPath,
    OutOfMap,
    PlanningError,
    StartBlocked,
)
from move_base_lite.navigator import Decision, Navigator, Status
from move_base_lite.parameters import load_settings, settings_from_parameters

__all__ = [
    "ControlError",
    "Decision",
    "GoalBlocked",
    "NavigationError",
    "Navigator",
    "NavigatorSettings",
    "NoPath",
    "OutOfMap",
    "PlanningError",
    "StartBlocked",
    "Status",
    "load_settings",
    "settings_from_parameters",
]
