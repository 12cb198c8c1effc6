"""The home service robot as a whole: launching, supervising and judging missions, and commanding it."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from home_service.ros.commander import Commander, CommanderError, Outcome, Result

__all__ = ["Commander", "CommanderError", "Outcome", "Result"]


def __getattr__(name: str):
    """The commander's names, imported when they are first asked for: ROS takes its time."""
    if name not in __all__:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    from home_service.ros import commander

    return getattr(commander, name)
