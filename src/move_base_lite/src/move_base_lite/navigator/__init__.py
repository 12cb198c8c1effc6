"""Navigator: move_base's state machine without ROS."""

from move_base_lite.navigator.decision import Decision, GoalOutcome, GoalProgress, RecoveryTrigger, Status
from move_base_lite.navigator.inputs import NavigatorInputs, RobotState
from move_base_lite.navigator.navigator import Navigator
from move_base_lite.navigator.zones import NavigationZone, Zones, load_zones

__all__ = [
    "Decision",
    "Navigator",
    "GoalOutcome",
    "GoalProgress",
    "NavigatorInputs",
    "RobotState",
    "Status",
    "RecoveryTrigger",
    "NavigationZone",
    "Zones",
    "load_zones",
]
