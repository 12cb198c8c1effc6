"""Whether a robot gets on with what it was told to do."""

import math

from planar import Pose2

PROGRESS_DISTANCE = 0.1
STRANDED_REFUSALS = 8
"""So many goals refused at the same place say more about the robot than about the goals."""


class ProgressWatch:
    """Notices when a robot comes no nearer to its goal for ``timeout`` seconds, or never gets away."""

    def __init__(self, timeout: float):
        self._timeout = timeout
        self._nearest = math.inf
        self._progress_at = 0.0
        self._refused_at = Pose2()
        self._refused_here = 0

    def restart(self, now: float) -> None:
        """There is a new goal."""
        self._nearest, self._progress_at = math.inf, now

    def goal_moved(self) -> None:
        """The goal is elsewhere now: that the robot is nearer or farther is not its doing."""
        self._nearest = math.inf

    def is_stuck(self, now: float, distance: float) -> bool:
        """Whether the robot, now at this distance from its goal, has come no nearer for too long."""
        if distance < self._nearest - PROGRESS_DISTANCE:
            if math.isfinite(self._nearest):
                self._progress_at = now
            self._nearest = distance
        return now - self._progress_at > self._timeout

    def note_refusal(self, robot: Pose2) -> None:
        """A goal was refused while the robot was there."""
        if self._refused_at.distance_to(robot) > PROGRESS_DISTANCE:
            self._refused_at, self._refused_here = robot, 0
        self._refused_here += 1

    @property
    def is_stranded(self) -> bool:
        """Whether too many goals were refused at the same place."""
        return self._refused_here >= STRANDED_REFUSALS
