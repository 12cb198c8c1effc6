"""The likelihood field: how well a beam's end fits the map, by where it ends."""

import math
from dataclasses import dataclass

import numpy as np

from planar import OCCUPIED, OccupancyGrid, Pose2
from planar.distance_field import distance_field


@dataclass(frozen=True, eq=False)
class LikelihoodField:
    """exp(-d^2 / 2 sigma^2) for each cell, d being its distance to the nearest obstacle (table 6.3).

    ``fit``: float32 (rows, cols), 1 on an obstacle. ``fit_outside``: the value off the map.
    """

    fit: np.ndarray
    fit_outside: float
    sigma: float
    resolution: float
    origin: Pose2

    def fit_at_distance(self, distance: float) -> float:
        """The field's value at this distance, metres, from the nearest obstacle."""
        return math.exp(-0.5 * (distance / self.sigma) ** 2)


def likelihood_field(grid: OccupancyGrid, sigma: float, max_distance: float) -> LikelihoodField:
    """The field of a map's occupied cells; distances are told apart up to ``max_distance``, metres."""
    distances = distance_field(grid.cells == OCCUPIED, grid.resolution, max_distance)
    fit = np.exp(-0.5 * (distances / np.float32(sigma)) ** 2)
    outside = math.exp(-0.5 * (max_distance / sigma) ** 2)
    return LikelihoodField(fit, outside, sigma, grid.resolution, grid.origin)
