"""Navigation with move_base's behaviour, without ROS: from goal, poses and scans to velocity commands.

Exports the Navigator, its settings, and the contracts of user-defined plugins with the types they use.
"""

from move_base_lite.config import NavigatorSettings
from move_base_lite.control import ControlContext, ControllerSettings, LocalPlanner, Plan, Trajectory
from move_base_lite.costmap import CostmapPlacement, CostmapWindow, Layer, LayerContext, LayerSettings
from move_base_lite.errors import (
    ControlError,
    GoalBlocked,
    NavigationError,
    NoPath,
    OutOfMap,
    PlanningError,
    PluginFailed,
    StartBlocked,
)
from move_base_lite.move_base import MoveBase, PoseHistory
from move_base_lite.navigator import Decision, Navigator, NavigatorInputs, RobotState, Status
from move_base_lite.parameters import load_settings, settings_from_parameters
from move_base_lite.planning import GlobalPlanner, PlannerSettings, PlanRequest
from move_base_lite.recovery import RecoveryBehavior, RecoveryContext, RecoverySettings
from planar.deprecation import deprecated_names

__all__ = [
    "ControlError",
    "ControllerSettings",
    "CostmapPlacement",
    "CostmapWindow",
    "Decision",
    "GlobalPlanner",
    "GoalBlocked",
    "Layer",
    "LayerContext",
    "LayerSettings",
    "LocalPlanner",
    "MoveBase",
    "NavigationError",
    "Navigator",
    "NavigatorInputs",
    "NavigatorSettings",
    "NoPath",
    "OutOfMap",
    "Plan",
    "PlanRequest",
    "PlannerSettings",
    "PlanningError",
    "PluginFailed",
    "PoseHistory",
    "RecoveryBehavior",
    "RecoveryContext",
    "RecoverySettings",
    "RobotState",
    "ControlContext",
    "StartBlocked",
    "Status",
    "Trajectory",
    "load_settings",
    "settings_from_parameters",
]

__getattr__ = deprecated_names(
    __name__,
    {
        "Placement": "CostmapPlacement",
        "Situation": "ControlContext",
        "Site": "LayerContext",
        "Window": "CostmapWindow",
    },
)
