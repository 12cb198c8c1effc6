"""Orders and events between a task and the component that drives the robot; independent of ROS."""

import enum
from dataclasses import dataclass
from typing import Union


@dataclass(frozen=True)
class FinishTask:
    """Order: end the task.

    Attributes:
        success: Whether the task succeeded.
        reason: Explanation for people.
    """

    success: bool
    reason: str


@dataclass(frozen=True)
class GoalReached:
    """Event: the robot reached the goal of the last order."""


@dataclass(frozen=True)
class GoalFailed:
    """Event: the robot did not reach the goal of the last order.

    Attributes:
        reason: Explanation for people.
        is_preempted: Whether another client replaced or cancelled the goal, rather than navigation failing.
    """

    reason: str
    is_preempted: bool = False


@dataclass(frozen=True)
class RobotDisplaced:
    """Event: at the goal, the scans no longer fit the map; the robot may have been carried away."""


class DriveResult(enum.Enum):
    """How a drive to a goal ended."""

    REACHED = "reached"
    PREEMPTED = "preempted"
    """Another goal replaced it, or a client cancelled it."""
    FAILED = "failed"


_RESULTS = {
    "SUCCEEDED": DriveResult.REACHED,
    "PREEMPTED": DriveResult.PREEMPTED,
    "RECALLED": DriveResult.PREEMPTED,
}


@dataclass(frozen=True)
class DriveOutcome:
    """How a drive to a goal ended, in actionlib's terms.

    Attributes:
        status: Name of the last status in actionlib_msgs/GoalStatus.
        text: Status text; may be empty.
    """

    status: str
    text: str

    @property
    def result(self) -> DriveResult:
        return _RESULTS.get(self.status, DriveResult.FAILED)

    @property
    def event(self) -> Union[GoalReached, GoalFailed]:
        """The outcome as an event for a task."""
        if self.result is DriveResult.REACHED:
            return GoalReached()
        return GoalFailed(self.text or self.status, self.result is DriveResult.PREEMPTED)
