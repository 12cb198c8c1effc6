"""Check that a robot that has reached its goal is where localization estimates it to be."""

from collections import deque
from dataclasses import dataclass
from typing import Deque, Optional, Union

from planar import Pose2
from planar.driving import GoalFailed, GoalReached, RobotDisplaced
from planar.elapsed_time import ElapsedTime

# Below this fit a scan contradicts the estimated pose. The fit is amcl_lite's probability that the estimate
# is within half a metre of the true pose.
MIN_FIT = 0.2
# Number of scans that must fit: the latest may have corrected the estimate only after the robot had arrived.
RECENT_SCANS = 2
# Time that the robot stands, in which localization receives some scans [s].
STANDING_SECONDS = 1.0
# Distance that a relocalized robot may drive without being checked again [m].
SHORT_DISTANCE = 0.25
# Distance from where it arrived at which a robot is no longer there [m]; the error of the arrival adds to it.
DISPLACED_DISTANCE = 0.1


class RecentScanFit:
    """How well the last scans fit the map at the estimated pose."""

    def __init__(self) -> None:
        self._last: Deque[float] = deque(maxlen=RECENT_SCANS)

    def add(self, fit: float) -> None:
        """Add the fit of one more scan, a probability."""
        self._last.append(fit)

    @property
    def minimum(self) -> Optional[float]:
        """Worst fit of the last scans; None if there is none."""
        return min(self._last, default=None)


@dataclass(frozen=True)
class ResendGoal:
    """Order: send the goal once more, since the estimate may have been wrong."""


GoalOutcome = Union[None, GoalReached, GoalFailed]
ArrivalEvent = Union[GoalOutcome, ResendGoal, RobotDisplaced]


class ArrivalCheck:
    """Checks the arrival at one goal.

    If the last scans contradict the estimated pose, the robot stands for a moment, so that localization can
    correct the estimate, and is then sent to the goal once more: scans taken while turning may fit badly at
    the correct pose. A robot that has arrived with a confirmed pose and then contradicts it may have been
    displaced; one whose odometry has changed since its arrival has moved.

    Args:
        goal: Pose of the goal in the map.
    """

    def __init__(self, goal: Pose2):
        self._goal = goal
        self._standing: Optional[ElapsedTime] = None
        self._was_resent = self._was_relocalized = self._has_arrived = self._was_confirmed = False
        self._distance = 0.0
        self._arrived_at: Optional[Pose2] = None

    def check(
        self,
        outcome: GoalOutcome,
        robot: Pose2,
        fit: Optional[float],
        now: float,
        odometry: Optional[Pose2] = None,
    ) -> ArrivalEvent:
        """Judge the outcome of the goal; call it at each tick, also without a new outcome.

        Args:
            outcome: Outcome of the goal as reported by navigation, None if there is no new one.
            robot: Estimated pose in the map.
            fit: Worst fit of the last scans at that pose; None if it is not known.
            now: Time [s].
            odometry: Pose in the odometry frame; None if it is not known.

        Returns:
            The outcome to act on; ResendGoal; RobotDisplaced if the robot has probably been moved; or None.
        """
        if self._standing is not None:
            return self._wait_standing(fit, now)
        if self._has_arrived:
            return self._check_displaced(fit, odometry)
        if self._was_resent:
            self._distance = max(self._distance, self._goal.distance_to(robot))
        if not isinstance(outcome, GoalReached) or not _contradicts(fit) or self._is_still_near:
            self._has_arrived, self._arrived_at = isinstance(outcome, GoalReached), odometry
            return outcome
        if self._was_resent:
            return GoalFailed("the laser scan does not fit the map at the estimated pose: robot displaced?")
        self._standing = ElapsedTime()
        return self._wait_standing(fit, now)

    @property
    def _is_still_near(self) -> bool:
        """Whether the robot, relocalized while standing, has driven too short a distance to be lost again."""
        return self._was_relocalized and self._distance < SHORT_DISTANCE

    def _check_displaced(self, fit: Optional[float], odometry: Optional[Pose2]) -> Optional[RobotDisplaced]:
        was_confirmed = self._was_confirmed
        if fit is not None:  # no fit is fresh after a jump of time
            self._was_confirmed = not _contradicts(fit)
        has_moved = self._has_moved(odometry)
        return RobotDisplaced() if has_moved or (was_confirmed and _contradicts(fit)) else None

    def _has_moved(self, odometry: Optional[Pose2]) -> bool:
        """Whether the robot has left the place of its arrival; it is reported once."""
        if odometry is None:
            return False
        has_moved = (
            self._arrived_at is not None and odometry.distance_to(self._arrived_at) > DISPLACED_DISTANCE
        )
        if has_moved or self._arrived_at is None:
            self._arrived_at = odometry
        return has_moved

    def _wait_standing(self, fit: Optional[float], now: float) -> Optional[ResendGoal]:
        if self._standing is None or self._standing.update(now) < STANDING_SECONDS:
            return None
        self._standing, self._was_resent = None, True
        self._was_relocalized = not _contradicts(fit)
        return ResendGoal()


def _contradicts(fit: Optional[float]) -> bool:
    """Whether the last scans contradict the estimated pose; an unknown fit does not."""
    return fit is not None and fit < MIN_FIT
