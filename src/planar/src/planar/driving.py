"""What a task and whoever drives the robot for it tell each other; pure, so that both can be rehearsed."""

import enum
from dataclasses import dataclass
from typing import Union


@dataclass(frozen=True)
class FinishTask:
    """Order: the task is over, and why."""

    success: bool
    reason: str


@dataclass(frozen=True)
class GoalReached:
    """Event: the robot has arrived where the last order sent it."""


@dataclass(frozen=True)
class GoalFailed:
    """Event: the robot gave the last order up, and why.

    ``is_taken_over``: it could have gone on, but somebody else gave it another goal, or cancelled this one.
    """

    reason: str
    is_preempted: bool = False


@dataclass(frozen=True)
class RobotDisplaced:
    """Event: the robot, which stood there, sees something else: somebody may have carried it away."""


class DriveResult(enum.Enum):
    REACHED = "reached"
    PREEMPTED = "preempted"
    """Another goal took its place, or somebody cancelled it."""
    FAILED = "failed"


_RESULTS = {
    "SUCCEEDED": DriveResult.REACHED,
    "PREEMPTED": DriveResult.PREEMPTED,
    "RECALLED": DriveResult.PREEMPTED,
}


@dataclass(frozen=True)
class DriveOutcome:
    """How a drive to a goal ended.

    ``status``: the name of its last status in actionlib_msgs/GoalStatus. ``text``: why, if that was told.
    """

    status: str
    text: str

    @property
    def result(self) -> DriveResult:
        return _RESULTS.get(self.status, DriveResult.FAILED)

    @property
    def event(self) -> Union[GoalReached, GoalFailed]:
        """The same for a task that only cares whether the robot has arrived."""
        if self.result is DriveResult.REACHED:
            return GoalReached()
        return GoalFailed(self.text or self.status, self.result is DriveResult.PREEMPTED)
