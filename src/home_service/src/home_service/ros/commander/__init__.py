"""Python client for a robot that is driven by move_base."""

from home_service.ros.commander.commander import Commander, CommanderError
from home_service.ros.commander.outcomes import Feedback, Outcome, Result

__all__ = ["Commander", "CommanderError", "Feedback", "Outcome", "Result"]
