"""Commands for a robot that move_base drives."""

from home_service.ros.commander.commander import Commander, CommanderError
from home_service.ros.commander.outcomes import Feedback, Outcome, Result

__all__ = ["Commander", "CommanderError", "Feedback", "Outcome", "Result"]
