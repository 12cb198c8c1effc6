"""Progress and outcome of a command of the commander."""

import enum
from dataclasses import dataclass
from typing import Optional, Tuple

from planar import Pose2


class Result(enum.Enum):
    """How a command has ended."""

    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"
    TIMED_OUT = "timed out"


@dataclass(frozen=True)
class Outcome:
    """Outcome of a command.

    Attributes:
        result: How it has ended.
        reason: Why.
        missed: Indices of waypoints that were not reached.
    """

    result: Result
    reason: str
    missed: Tuple[int, ...] = ()

    @property
    def success(self) -> bool:
        return self.result is Result.SUCCEEDED


@dataclass(frozen=True)
class Feedback:
    """Progress of a command.

    Attributes:
        seconds: ROS time since its start [s].
        left: Remaining straight-line distance [m] or angle [rad]; None if not known yet.
        pose: Latest pose of the robot.
        waypoint: Index of the current waypoint.
    """

    seconds: float
    left: Optional[float]
    pose: Optional[Pose2] = None
    waypoint: int = 0
