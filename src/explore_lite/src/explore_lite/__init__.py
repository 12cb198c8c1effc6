"""Frontier exploration: drives a robot until the map has no reachable unknown left; pure but for node.py."""

from explore_lite.config import ExplorerSettings
from explore_lite.explorer import Explorer, ExplorerState, Finish, GoalReached, GoalRefused, GoTo
from explore_lite.frontiers import Frontier, find_frontiers

__all__ = [
    "Explorer",
    "ExplorerSettings",
    "ExplorerState",
    "Finish",
    "Frontier",
    "GoTo",
    "GoalReached",
    "GoalRefused",
    "find_frontiers",
]
