"""Whether a robot that has reached its goal is believed to be there."""

from collections import deque
from dataclasses import dataclass
from typing import Deque, Optional, Union

from planar import Pose2
from planar.driving import GoalFailed, GoalReached, RobotDisplaced
from planar.elapsed import ElapsedTime

# Below, the scan of the moment speaks against the robot's pose. As amcl_lite tells it: the probability that
# the pose is right to half a metre.
LEAST_FIT = 0.2
# So many scans have to speak for it: the newest may have corrected the pose only after the robot had arrived.
SCANS = 2
# In which a robot that stands is told by some scans where it is.
STANDING_SECONDS = 1.0
# Metres.
SHORT_WAY = 0.25


class Fit:
    """How well the last scans fit the map where the robot was believed to be."""

    def __init__(self) -> None:
        self._last: Deque[float] = deque(maxlen=SCANS)

    def take(self, fit: float) -> None:
        """That of one more scan."""
        self._last.append(fit)

    @property
    def least(self) -> Optional[float]:
        """Of those, None if nobody has told."""
        return min(self._last, default=None)


@dataclass(frozen=True)
class SendAgain:
    """The goal is to be pursued once more: the robot may be elsewhere, or not."""


Outcome = Union[None, GoalReached, GoalFailed]
Judged = Union[Outcome, SendAgain, RobotDisplaced]


class Arrival:
    """That at one goal. In doubt the robot stands for a moment, and is then sent there once more.

    Scans of a turn may fit badly where the robot is, and one that stands finds out where it is. One that has
    arrived and been sure of it, and is in doubt again, may have been carried away.
    """

    def __init__(self, goal: Pose2):
        self._goal = goal
        self._standing: Optional[ElapsedTime] = None
        self._is_sent_again = self._was_found = self._has_arrived = self._is_sure = False
        self._way = 0.0

    def judge(self, told: Outcome, robot: Pose2, fit: Optional[float], now: float) -> Judged:
        """What to make of what was ``told`` of the goal; to be asked all along, also if there is nothing new.

        ``robot``: where it is believed to be. The last scans fit the map there at least as well as ``fit``;
        None: nobody has told. ``now``: seconds.
        """
        if self._standing is not None:
            return self._stand(fit, now)
        if self._has_arrived:
            return self._watch(fit)
        if self._is_sent_again:
            self._way = max(self._way, self._goal.distance_to(robot))
        if not isinstance(told, GoalReached) or not _speaks_against(fit) or self._is_surely_near:
            self._has_arrived = isinstance(told, GoalReached)
            return told
        if self._is_sent_again:
            return GoalFailed("the robot may be elsewhere: what the laser sees does not fit the map there")
        self._standing = ElapsedTime()
        return self._stand(fit, now)

    @property
    def _is_surely_near(self) -> bool:
        """From where it was found, standing, it has come too short a way to be lost again."""
        return self._was_found and self._way < SHORT_WAY

    def _watch(self, fit: Optional[float]) -> Optional[RobotDisplaced]:
        was_sure, self._is_sure = self._is_sure, fit is not None and not _speaks_against(fit)
        return RobotDisplaced() if was_sure and _speaks_against(fit) else None

    def _stand(self, fit: Optional[float], now: float) -> Optional[SendAgain]:
        if self._standing is None or self._standing.at(now) < STANDING_SECONDS:
            return None
        self._standing, self._is_sent_again = None, True
        self._was_found = not _speaks_against(fit)
        return SendAgain()


def _speaks_against(fit: Optional[float]) -> bool:
    """Whether the last scans do against the robot's pose; what nobody has told does not."""
    return fit is not None and fit < LEAST_FIT
