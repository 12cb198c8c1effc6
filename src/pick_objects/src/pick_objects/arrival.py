"""Whether a robot that has reached its goal is believed to be there."""

from collections import deque
from typing import Deque, Optional, Union

from planar.driving import GoalReached, GoalRefused

# Below, the scan of the moment speaks against the robot's pose. As amcl_lite tells it: the probability that
# the pose is right to half a metre.
LEAST_FIT = 0.2
# So many scans have to speak for it: the newest may have corrected the pose only after the robot had arrived.
SCANS = 2


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


def believed(
    event: Union[None, GoalReached, GoalRefused], fit: Optional[float]
) -> Union[None, GoalReached, GoalRefused]:
    """What to make of ``event`` when the last scans fit the map at least that well; None: nobody has told."""
    if isinstance(event, GoalReached) and fit is not None and fit < LEAST_FIT:
        return GoalRefused("the robot may be elsewhere: what the laser sees does not fit the map there")
    return event
