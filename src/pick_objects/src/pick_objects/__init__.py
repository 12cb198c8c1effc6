"""Fetch and deliver: the errand as a pure state machine, and the node that sends its orders to move_base."""

from pick_objects.config import ErrandSettings
from pick_objects.errand import Errand, ErrandState, Finish, GoalReached, GoalRefused, GoTo

__all__ = ["Errand", "ErrandSettings", "ErrandState", "Finish", "GoTo", "GoalReached", "GoalRefused"]
