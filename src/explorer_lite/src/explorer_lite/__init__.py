"""Frontier exploration: drives a robot until the map has no reachable unknown left; pure but for node.py."""

from explorer_lite.config import ExplorerSettings
from explorer_lite.explorer import Explorer, ExplorerState, FinishTask, GoalFailed, GoalReached, GoTo
from explorer_lite.frontiers import Frontier, find_frontiers

__all__ = [
    "Explorer",
    "ExplorerSettings",
    "ExplorerState",
    "FinishTask",
    "Frontier",
    "GoTo",
    "GoalReached",
    "GoalFailed",
    "find_frontiers",
]
