"""What the Navigator decides in a control period."""

from dataclasses import dataclass
from enum import Enum
from typing import Optional

import numpy as np

from move_base_lite.control import TrajectorySamples
from move_base_lite.errors import NavigationError
from planar import Twist2


class Status(Enum):
    """What the Navigator is doing; the last three say, once, how a goal ended."""

    IDLE = "idle"
    PLANNING = "planning"
    CONTROLLING = "controlling"
    CLEARING = "clearing"
    SUCCEEDED = "succeeded"
    ABORTED = "aborted"
    CANCELLED = "cancelled"

    @property
    def is_final(self) -> bool:
        return self in (Status.SUCCEEDED, Status.ABORTED, Status.CANCELLED)


class RecoveryTrigger(Enum):
    """What made recovery necessary, with move_base's text of giving up for it."""

    PLANNING = "Failed to find a valid plan. Even after executing recovery behaviors."
    CONTROLLING = "Failed to find a valid control. Even after executing recovery behaviors."
    OSCILLATION = "Robot is oscillating. Even after executing recovery behaviors."


SUCCESS_TEXT = "Goal reached."
STALE_SENSOR_TEXT = "Sensor data is out of date, we're not going to allow commanding of the base for safety"


def with_reason(text: str, error: NavigationError) -> str:
    """move_base's text, which clients match on, followed by the reason it keeps to itself."""
    return f"{text} [code={error.code}: {error}]"


SUCCEEDED_OUTCOME = 0
CANCELLED_OUTCOME = 11


@dataclass(frozen=True)
class GoalProgress:
    """How the pursuit of a goal stands: seconds and metres driven so far, recoveries used, and what is left.

    ``seconds_left`` is an estimate from the speed so far.
    """

    seconds: float
    travelled: float
    recoveries: int
    distance_left: float
    seconds_left: float


@dataclass(frozen=True)
class GoalOutcome:
    """How a goal ended. ``code``: the number move_base_flex has for it; ``reason``: the same as a word.

    ``distance_to_goal`` in metres, ``angle_to_goal`` in radians, of the robot at the end.
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
    """A recovery behaviour that begins in this period: the ``index``-th, from 0, of ``total``."""

    name: str
    index: int
    total: int


@dataclass(frozen=True, eq=False)
class Decision:
    """What to do in this control period.

    ``command``: the velocity to send, None while there is no goal. ``text``: why, where there is something
    to tell. ``plan_xy``: (N, 2) in the map, a plan made in this period, empty if none was found.
    ``trajectory``: poses (N, 3) the command leads through, and ``followed_xy``: (M, 2) the part of the plan
    it follows, both in the local frame. ``trajectory_samples``: the trajectories that DWA evaluated, valid
    until the next period. ``progress``: while there is a goal. ``outcome``: with a goal's last decision.
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
