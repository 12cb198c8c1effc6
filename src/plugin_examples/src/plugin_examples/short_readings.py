"""A sensor model for crowded rooms: a beam that is too short weighs little, one that is too long a lot.

The likelihood field (Probabilistic Robotics, table 6.3) plus the short readings of table 6.1: a beam that
ends in free space may have hit a person; none ends inside of a wall.
"""

import numpy as np
from scipy.ndimage import binary_dilation

from amcl_lite import LocalizerSettings
from amcl_lite.sensor.beams import Beams
from planar import FREE, OCCUPIED, OccupancyGrid
from planar.geometry.distance_field import distance_field
from planar.geometry.pose import cos_sin

# Densities of a hit (at its peak), of a short and of an unexplained reading [1/m].
HIT, SHORT, UNEXPLAINED = 2.4, 0.17, 0.006
# Standard deviation of a hit [m], and weight of a beam: beams are correlated, as one person shortens many.
SIGMA, BEAM_WEIGHT = 0.1, 0.2


class ShortReadings:
    """Sensor model: a likelihood field in which a beam may also end in free space.

    Args:
        grid: The map.
        settings: Not used.
    """

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings):
        self._grid = grid
        # Beams end at the surface of a wall; a plain likelihood field also accepts its inside.
        faces = (grid.cells == OCCUPIED) & binary_dilation(grid.cells == FREE)
        near = np.exp(-0.5 * (distance_field(faces, grid.resolution) / SIGMA) ** 2)
        self._logarithms = np.log(HIT * near + SHORT * (grid.cells == FREE) + UNEXPLAINED)

    def log_likelihoods(self, poses: np.ndarray, beams: Beams) -> np.ndarray:
        """Return the log-likelihoods of a scan.

        Args:
            poses: Particles (N, 3): x, y, yaw of the base in the map frame.
            beams: Beams of the scan, with their ends in the base frame.

        Returns:
            Log-likelihood (N,) of each particle.
        """
        ends = beams.ends_xy
        cos, sin = cos_sin(poses[:, 2:])
        x = poses[:, :1] + cos * ends[:, 0] - sin * ends[:, 1]
        y = poses[:, 1:2] + sin * ends[:, 0] + cos * ends[:, 1]
        cells = self._grid.cells_of(np.column_stack((x.ravel(), y.ravel())))
        inside = self._grid.contains(cells)
        log_density = np.full(x.size, np.log(UNEXPLAINED))
        log_density[inside] = self._logarithms[tuple(cells[inside].T)]
        return BEAM_WEIGHT * log_density.reshape(x.shape).sum(axis=1)
