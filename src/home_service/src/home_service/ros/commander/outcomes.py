"""How far a command of the commander has come, and how it ended."""

import enum
from dataclasses import dataclass
from typing import Optional, Tuple

from planar import Pose2


class Result(enum.Enum):
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"
    TIMED_OUT = "timed out"


@dataclass(frozen=True)
class Outcome:
    """How a command ended, and why. ``missed``: the numbers of waypoints that were not reached."""

    result: Result
    reason: str
    missed: Tuple[int, ...] = ()

    @property
    def success(self) -> bool:
        return self.result is Result.SUCCEEDED


@dataclass(frozen=True)
class Feedback:
    """How far a command has come. ``left``: metres (straight) or radians; None if not known yet.

    ``waypoint``: the number, from 0, of the one that the robot is on its way to.
    """

    seconds: float
    left: Optional[float]
    pose: Optional[Pose2] = None
    waypoint: int = 0
