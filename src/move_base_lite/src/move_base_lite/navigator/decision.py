"""Decision: the output of the Navigator in a control period."""

from dataclasses import dataclass
from enum import Enum
from typing import Optional

import numpy as np

from move_base_lite.control import TrajectorySamples
from move_base_lite.errors import NavigationError
from planar import Twist2


class Status(Enum):
    """State of navigation; the last three are reported once, when a goal ends."""

    IDLE = "idle"
    WAITING = "waiting"
    PLANNING = "planning"
    CONTROLLING = "controlling"
    CLEARING = "clearing"
    SUCCEEDED = "succeeded"
    ABORTED = "aborted"
    CANCELLED = "cancelled"

    @property
    def is_final(self) -> bool:
        """Whether the goal has ended."""
        return self in (Status.SUCCEEDED, Status.ABORTED, Status.CANCELLED)


class RecoveryTrigger(Enum):
    """Failure that made recovery necessary; the value is move_base's abort text for it."""

    PLANNING = "Failed to find a valid plan. Even after executing recovery behaviors."
    CONTROLLING = "Failed to find a valid control. Even after executing recovery behaviors."
    OSCILLATION = "Robot is oscillating. Even after executing recovery behaviors."


SUCCESS_TEXT = "Goal reached."
STALE_SENSOR_TEXT = "Sensor data is out of date, we're not going to allow commanding of the base for safety"


def with_reason(text: str, error: NavigationError) -> str:
    """Append the reason to move_base's text, which clients match and which does not contain it.

    Args:
        text: move_base's text.
        error: Reason of the failure.
    """
    return f"{text} [code={error.code}: {error}]"


SUCCEEDED_OUTCOME = 0
CANCELLED_OUTCOME = 11


@dataclass(frozen=True)
class GoalProgress:
    """Progress towards the goal.

    Attributes:
        seconds: Time since the goal was accepted [s].
        travelled: Distance travelled since then [m].
        recoveries: Number of recovery behaviours used.
        distance_left: Length of the path that remains [m].
        seconds_left: Estimate of the remaining time, from the average speed [s].
    """

    seconds: float
    travelled: float
    recoveries: int
    distance_left: float
    seconds_left: float


@dataclass(frozen=True)
class GoalOutcome:
    """Outcome of a goal.

    Attributes:
        code: Outcome code of move_base_flex (mbf_msgs/MoveBaseResult).
        reason: The outcome as a word, such as NO_PATH.
        text: Text of the action's result.
        distance_to_goal: Distance of the robot from the goal at the end [m].
        angle_to_goal: Difference of headings at the end [rad].
        recoveries: Number of recovery behaviours used.
        seconds: Time since the goal was accepted [s].
    """

    code: int
    reason: str
    text: str
    distance_to_goal: float = 0.0
    angle_to_goal: float = 0.0
    recoveries: int = 0
    seconds: float = 0.0


@dataclass(frozen=True)
class RecoveryStart:
    """A recovery behaviour that starts in this period.

    Attributes:
        name: Its name in ~recovery_behaviors.
        index: Its position in the list, from 0.
        total: Length of the list.
    """

    name: str
    index: int
    total: int


@dataclass(frozen=True, eq=False)
class Decision:
    """Output of ``Navigator.tick``.

    Attributes:
        status: State of the Navigator.
        command: Velocity command; None while there is no goal.
        text: Why the robot stands or the goal ended; empty if there is nothing to report.
        plan_xy: (N, 2) path in the map, if a plan was made in this period; empty if planning failed.
        trajectory: (N, 3) predicted poses x, y, yaw for the command, in the local frame.
        followed_xy: (M, 2) part of the plan that the command follows, in the local frame.
        trajectory_samples: Samples of the local planner, if it offers them; valid until the next tick.
        recovery: Recovery behaviour that starts in this period.
        progress: Progress while there is a goal.
        outcome: Outcome, in the last decision for a goal.
    """

    status: Status
    command: Optional[Twist2] = None
    text: str = ""
    plan_xy: Optional[np.ndarray] = None
    trajectory: Optional[np.ndarray] = None
    followed_xy: Optional[np.ndarray] = None
    trajectory_samples: Optional[TrajectorySamples] = None
    recovery: Optional[RecoveryStart] = None
    progress: Optional[GoalProgress] = None
    outcome: Optional[GoalOutcome] = None
