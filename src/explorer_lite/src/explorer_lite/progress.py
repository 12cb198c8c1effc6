"""Progress of the robot towards its goal."""

import math

from planar import Pose2

PROGRESS_DISTANCE = 0.1
# Goals refused at one place after which the robot counts as stranded.
MAX_REFUSALS_IN_PLACE = 8


class GoalProgressChecker:
    """Detects that the robot makes no progress towards its goal, or that all goals are refused.

    Args:
        timeout: Time without progress after which the robot is stuck [s].
    """

    def __init__(self, timeout: float):
        self._timeout = timeout
        self._nearest = math.inf
        self._progress_at = 0.0
        self._refused_at = Pose2()
        self._refused_here = 0

    def restart(self, now: float) -> None:
        """Reset the checker for a new goal.

        Args:
            now: Time [s].
        """
        self._nearest, self._progress_at = math.inf, now

    def on_goal_moved(self) -> None:
        """Use the next distance as the reference: the goal has moved, not the robot."""
        self._nearest = math.inf

    def is_stuck(self, now: float, distance: float) -> bool:
        """Return whether the robot has come no nearer to its goal within the timeout.

        Args:
            now: Time [s].
            distance: Distance from the robot to its goal [m].
        """
        if distance < self._nearest - PROGRESS_DISTANCE:
            if math.isfinite(self._nearest):
                self._progress_at = now
            self._nearest = distance
        return now - self._progress_at > self._timeout

    def on_goal_refused(self, robot: Pose2) -> None:
        """Count a refused goal at the robot's pose."""
        if self._refused_at.distance_to(robot) > PROGRESS_DISTANCE:
            self._refused_at, self._refused_here = robot, 0
        self._refused_here += 1

    @property
    def is_stranded(self) -> bool:
        """Whether too many goals were refused at the same place."""
        return self._refused_here >= MAX_REFUSALS_IN_PLACE
