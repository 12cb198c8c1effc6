"""Progress of the robot along its plan."""

import math

import numpy as np

# Stretch of the plan in which the point nearest to the robot is searched [m].
SEARCH_AHEAD = 1.5


class PathProgress:
    """A plan and the point of it that the robot has reached, which only moves forward.

    Attributes:
        path_xy: (N, 2) [m], in the map frame.
    """

    def __init__(self, path_xy: np.ndarray):
        """Start at the first point of a path.

        Args:
            path_xy: (N, 2), in the map frame [m].
        """
        self.path_xy = path_xy
        steps = np.linalg.norm(np.diff(path_xy, axis=0), axis=1)
        self._travelled = np.concatenate(([0.0], np.cumsum(steps)))
        self._index = 0

    def advance(self, x: float, y: float) -> None:
        """Advance to the point nearest to the robot, within SEARCH_AHEAD along the path.

        Args:
            x: Robot position in the map frame [m].
            y: Robot position in the map frame [m].
        """
        end = int(np.searchsorted(self._travelled, self._travelled[self._index] + SEARCH_AHEAD)) + 1
        ahead = self.path_xy[self._index : end]
        self._index += int(np.argmin((ahead[:, 0] - x) ** 2 + (ahead[:, 1] - y) ** 2))

    @property
    def remaining_xy(self) -> np.ndarray:
        """The rest of the plan (M, 2), at least its last point."""
        return self.path_xy[self._index :]

    @property
    def distance_left(self) -> float:
        """Length of the rest of the plan [m]."""
        return float(self._travelled[-1] - self._travelled[self._index])

    def heading_error(self, x: float, y: float, yaw: float, lookahead: float) -> float:
        """Compute the angle from the robot's heading to a point ahead on the plan.

        Args:
            x: Robot position in the map frame [m].
            y: Robot position in the map frame [m].
            yaw: Heading of the robot [rad].
            lookahead: Distance of the point along the plan [m].

        Returns:
            Angle in [-pi, pi).
        """
        target = min(
            int(np.searchsorted(self._travelled, self._travelled[self._index] + lookahead)),
            len(self.path_xy) - 1,
        )
        to_x, to_y = self.path_xy[target] - (x, y)
        return (math.atan2(to_y, to_x) - yaw + math.pi) % (2.0 * math.pi) - math.pi
