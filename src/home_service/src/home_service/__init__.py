"""The home service robot as a whole: commands, and the Commander that drives the robot from Python."""

from typing import TYPE_CHECKING

from planar.lazy_names import lazy_names

if TYPE_CHECKING:
    from home_service.ros.commander import Commander, CommanderError, Outcome, Result

__all__ = ["Commander", "CommanderError", "Outcome", "Result"]

# Importing ROS takes time.
__getattr__ = lazy_names(
    __name__, {"home_service.ros.commander": ("Commander", "CommanderError", "Outcome", "Result")}
)
