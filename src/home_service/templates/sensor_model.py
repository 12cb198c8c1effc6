"""TITLE: a sensor model for amcl_lite."""

import numpy as np

from amcl_lite import LocalizerSettings
from amcl_lite.sensor.beams import Beams
from planar import OCCUPIED, OccupancyGrid
from planar.geometry.distance_field import distance_field

# Standard deviation and maximum of the distance from a wall [m]; weight of a beam, as beams are correlated.
SIGMA, FARTHEST, BEAM_WEIGHT = 0.1, 0.5, 0.2


class CLASS:
    """Likelihood field: the closer to an obstacle a beam ends, the likelier it is."""

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings):
        self._grid = grid
        apart = np.minimum(distance_field(grid.cells == OCCUPIED, grid.resolution), FARTHEST)
        self._logarithms = -0.5 * (apart / SIGMA) ** 2

    def log_likelihoods(self, poses: np.ndarray, beams: Beams) -> np.ndarray:
        """See amcl_lite.sensor.custom_model.SensorModel: (N,) for poses (N, 3)."""
        ends = beams.ends_xy
        cos, sin = np.cos(poses[:, 2:]), np.sin(poses[:, 2:])
        x = poses[:, :1] + cos * ends[:, 0] - sin * ends[:, 1]
        y = poses[:, 1:2] + sin * ends[:, 0] + cos * ends[:, 1]
        cells = self._grid.cells_of(np.column_stack((x.ravel(), y.ravel())))
        inside = self._grid.contains(cells)
        log_density = np.full(x.size, self._logarithms.min())
        log_density[inside] = self._logarithms[tuple(cells[inside].T)]
        return BEAM_WEIGHT * log_density.reshape(x.shape).sum(axis=1)
