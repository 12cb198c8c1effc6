"""Frontier exploration: drives the robot until no reachable frontier is left. ROS is in ``ros/`` only."""

from explorer_lite.config import ExplorerSettings
from explorer_lite.explorer import Explorer, ExplorerState, FinishTask, GoalFailed, GoalReached, SendGoal
from explorer_lite.frontiers import Frontier, find_frontiers
from planar.deprecation import deprecated_names

__all__ = [
    "Explorer",
    "ExplorerSettings",
    "ExplorerState",
    "FinishTask",
    "Frontier",
    "GoalReached",
    "GoalFailed",
    "SendGoal",
    "find_frontiers",
]

__getattr__ = deprecated_names(
    __name__, {"Finish": "FinishTask", "GoTo": "SendGoal", "GoalRefused": "GoalFailed"}
)
