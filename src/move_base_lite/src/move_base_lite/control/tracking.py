"""Where along the plan the robot is."""

import math

import numpy as np

SEARCH_AHEAD = 1.5


class Tracking:
    """A plan and the robot's progress along it, which never goes back: ``path_xy`` (N, 2), metres."""

    def __init__(self, path_xy: np.ndarray):
        self.path_xy = path_xy
        steps = np.linalg.norm(np.diff(path_xy, axis=0), axis=1)
        self._travelled = np.concatenate(([0.0], np.cumsum(steps)))
        self._index = 0

    def advance(self, x: float, y: float) -> None:
        """Moves on to the nearest point within a stretch ahead."""
        end = int(np.searchsorted(self._travelled, self._travelled[self._index] + SEARCH_AHEAD)) + 1
        ahead = self.path_xy[self._index : end]
        self._index += int(np.argmin((ahead[:, 0] - x) ** 2 + (ahead[:, 1] - y) ** 2))

    @property
    def ahead_xy(self) -> np.ndarray:
        """What is left of the plan (M, 2), at least its last point."""
        return self.path_xy[self._index :]

    @property
    def distance_left(self) -> float:
        return float(self._travelled[-1] - self._travelled[self._index])

    def heading_error(self, x: float, y: float, yaw: float, lookahead: float) -> float:
        """Angle from the robot's heading to the plan's point ``lookahead`` metres on, in [-pi, pi)."""
        target = min(
            int(np.searchsorted(self._travelled, self._travelled[self._index] + lookahead)),
            len(self.path_xy) - 1,
        )
        to_x, to_y = self.path_xy[target] - (x, y)
        return (math.atan2(to_y, to_x) - yaw + math.pi) % (2.0 * math.pi) - math.pi
