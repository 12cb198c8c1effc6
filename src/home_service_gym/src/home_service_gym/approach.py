"""How much nearer a robot comes to where it is to go."""

import math

import numpy as np

from home_service_gym.ground import Ground
from planar import Pose2


class Approach:
    """To ``goal`` along the ways of a ground, from ``start``."""

    def __init__(self, ground: Ground, goal: Pose2, start: Pose2):
        self.goal = goal
        self._ground = ground
        self._distances = ground.distances_to(goal)
        self._left = ground.distance_at(self._distances, start)

    def ahead(self, base: Pose2, metres: float) -> np.ndarray:
        """The point (2,), seen from the robot, that lies so far ahead on the way."""
        count = round(metres / self._ground.grid.resolution) + 1
        way_xy = self._ground.way(self._distances, base, count)
        return base.inverse().transform_points(way_xy[-1:])[0]

    def metres(self, base: Pose2) -> float:
        """Nearer by since the last call; 0 where no way is known, as close to a wall."""
        left = self._ground.distance_at(self._distances, base)
        if not math.isfinite(left):
            return 0.0
        before, self._left = self._left, left
        return before - left if math.isfinite(before) else 0.0
