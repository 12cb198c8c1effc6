"""The home service robot as a whole: commands, and the Commander that drives the robot from Python."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from home_service.ros.commander import Commander, CommanderError, Outcome, Result

__all__ = ["Commander", "CommanderError", "Outcome", "Result"]


def __getattr__(name: str):
    """Import the commander's names when they are first used, since importing ROS takes time."""
    if name not in __all__:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    from home_service.ros import commander

    return getattr(commander, name)
