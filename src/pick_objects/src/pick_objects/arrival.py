"""Whether a robot that has reached its goal is believed to be there."""

from collections import deque
from dataclasses import dataclass
from typing import Deque, Optional, Union

from planar import Pose2
from planar.driving import GoalFailed, GoalReached, RobotDisplaced
from planar.elapsed import ElapsedTime

# Below, the scan of the moment speaks against the robot's pose. As amcl_lite tells it: the probability that
# the pose is right to half a metre.
MIN_FIT = 0.2
# So many scans have to speak for it: the newest may have corrected the pose only after the robot had arrived.
RECENT_SCANS = 2
# In which a robot that stands is told by some scans where it is.
STANDING_SECONDS = 1.0
# Metres.
SHORT_DISTANCE = 0.25


class RecentScanFit:
    """How well the last scans fit the map where the robot was believed to be."""

    def __init__(self) -> None:
        self._last: Deque[float] = deque(maxlen=RECENT_SCANS)

    def add(self, fit: float) -> None:
        """That of one more scan."""
        self._last.append(fit)

    @property
    def minimum(self) -> Optional[float]:
        """Of those, None if nobody has told."""
        return min(self._last, default=None)


@dataclass(frozen=True)
class ResendGoal:
    """The goal is to be pursued once more: the robot may be elsewhere, or not."""


GoalOutcome = Union[None, GoalReached, GoalFailed]
ArrivalEvent = Union[GoalOutcome, ResendGoal, RobotDisplaced]


class ArrivalCheck:
    """That at one goal. In doubt the robot stands for a moment, and is then sent there once more.

    Scans of a turn may fit badly where the robot is, and one that stands finds out where it is. One that has
    arrived and been sure of it, and is in doubt again, may have been carried away.
    """

    def __init__(self, goal: Pose2):
        self._goal = goal
        self._standing: Optional[ElapsedTime] = None
        self._was_resent = self._was_relocalized = self._has_arrived = self._was_confirmed = False
        self._distance = 0.0

    def check(self, told: GoalOutcome, robot: Pose2, fit: Optional[float], now: float) -> ArrivalEvent:
        """What to make of what was ``told`` of the goal; to be asked all along, also if there is nothing new.

        ``robot``: where it is believed to be. The last scans fit the map there at least as well as ``fit``;
        None: nobody has told. ``now``: seconds.
        """
        if self._standing is not None:
            return self._wait_standing(fit, now)
        if self._has_arrived:
            return self._check_displaced(fit)
        if self._was_resent:
            self._distance = max(self._distance, self._goal.distance_to(robot))
        if not isinstance(told, GoalReached) or not _contradicts(fit) or self._is_still_near:
            self._has_arrived = isinstance(told, GoalReached)
            return told
        if self._was_resent:
            return GoalFailed("the robot may be elsewhere: what the laser sees does not fit the map there")
        self._standing = ElapsedTime()
        return self._wait_standing(fit, now)

    @property
    def _is_still_near(self) -> bool:
        """From where it was found, standing, it has come too short a way to be lost again."""
        return self._was_relocalized and self._distance < SHORT_DISTANCE

    def _check_displaced(self, fit: Optional[float]) -> Optional[RobotDisplaced]:
        was_confirmed, self._was_confirmed = self._was_confirmed, fit is not None and not _contradicts(fit)
        return RobotDisplaced() if was_confirmed and _contradicts(fit) else None

    def _wait_standing(self, fit: Optional[float], now: float) -> Optional[ResendGoal]:
        if self._standing is None or self._standing.at(now) < STANDING_SECONDS:
            return None
        self._standing, self._was_resent = None, True
        self._was_relocalized = not _contradicts(fit)
        return ResendGoal()


def _contradicts(fit: Optional[float]) -> bool:
    """Whether the last scans do against the robot's pose; what nobody has told does not."""
    return fit is not None and fit < MIN_FIT
