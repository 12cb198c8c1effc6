"""Whether a robot that has reached its goal is believed to be there."""

from typing import Optional, Union

from planar.driving import GoalReached, GoalRefused

# Below, the scan of the moment speaks against the robot's pose. As amcl_lite tells it: the probability that
# the pose is right to half a metre.
LEAST_FIT = 0.2


def believed(
    event: Union[None, GoalReached, GoalRefused], fit: Optional[float]
) -> Union[None, GoalReached, GoalRefused]:
    """What to make of ``event`` when the last scan fits the map that well; None: nobody has told."""
    if isinstance(event, GoalReached) and fit is not None and fit < LEAST_FIT:
        return GoalRefused("the robot may be elsewhere: what the laser sees does not fit the map there")
    return event
