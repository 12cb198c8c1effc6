"""A sensor model for rooms full of people: a beam that is cut short says little, one that is too long a lot.

The likelihood field (Probabilistic Robotics, table 6.3) with the short readings of table 6.1, which it lacks:
a beam that ends where the map shows free floor may have met somebody; none ends inside a wall.
"""

import numpy as np
from scipy.ndimage import binary_dilation

from amcl_lite import LocalizerSettings
from amcl_lite.sensor.beams import Beams
from planar import FREE, OCCUPIED, OccupancyGrid
from planar.geometry.distance_field import distance_field

# Densities, 1/m, of a beam that meets what the map shows (its peak), is cut short, or cannot be explained.
HIT, SHORT, UNEXPLAINED = 2.4, 0.17, 0.006
# Metres: the standard deviation of a hit. Beams are no witnesses of their own: a person cuts many of them.
SIGMA, TRUST = 0.1, 0.2


class ShortReadings:
    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings):
        self._grid = grid
        # A wall is met at its face; the likelihood field takes all of a thick one for as good.
        faces = (grid.cells == OCCUPIED) & binary_dilation(grid.cells == FREE)
        near = np.exp(-0.5 * (distance_field(faces, grid.resolution) / SIGMA) ** 2)
        self._logarithms = np.log(HIT * near + SHORT * (grid.cells == FREE) + UNEXPLAINED)

    def log_likelihoods(self, poses: np.ndarray, beams: Beams) -> np.ndarray:
        ends = beams.ends_xy
        cos, sin = np.cos(poses[:, 2:]), np.sin(poses[:, 2:])
        x = poses[:, :1] + cos * ends[:, 0] - sin * ends[:, 1]
        y = poses[:, 1:2] + sin * ends[:, 0] + cos * ends[:, 1]
        cells = self._grid.cells_of(np.column_stack((x.ravel(), y.ravel())))
        inside = self._grid.contains(cells)
        told = np.full(x.size, np.log(UNEXPLAINED))
        told[inside] = self._logarithms[tuple(cells[inside].T)]
        return TRUST * told.reshape(x.shape).sum(axis=1)
