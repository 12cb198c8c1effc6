"""The sensor model selected by the settings, prepared for one map."""

import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.sensor.beams import Beams
from amcl_lite.sensor.custom_model import CONTRACT
from amcl_lite.sensor.likelihood_field import likelihood_field
from amcl_lite.sensor.sensor_model import log_beam_model, log_likelihood_field, log_likelihood_field_prob
from planar import FREE, OCCUPIED, OccupancyGrid


class ScanLikelihood:
    """Log-likelihoods of scans in one map; ``field`` is the map's likelihood field.

    Raises LocalizationError if a user-defined sensor model fails.
    """

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings):
        self.field = likelihood_field(grid, settings.sigma_hit, settings.likelihood_max_distance)
        self._settings = settings
        self._custom = (
            CONTRACT.make(settings.sensor_plugin, grid, settings) if settings.sensor_plugin else None
        )
        self._opaque_grid = _opaque(grid) if settings.sensor_model == "beam" else None

    def log_likelihoods(self, poses: np.ndarray, beams: Beams, has_converged: bool) -> np.ndarray:
        """Return log-likelihoods (N,) of particles (N, 3); beams are skipped only after convergence."""
        settings = self._settings
        if self._custom is not None:
            return self._custom.log_likelihoods(poses, beams)
        if self._opaque_grid is not None:
            return log_beam_model(poses, beams, self._opaque_grid, settings)
        if settings.sensor_model == "likelihood_field_prob":
            skip_beams = settings.beam_skip and has_converged
            return log_likelihood_field_prob(poses, beams, self.field, settings, skip_beams)
        return log_likelihood_field(poses, beams, self.field, settings)


def _opaque(grid: OccupancyGrid) -> OccupancyGrid:
    """Mark all cells that are not free as occupied, since rays of amcl end there."""
    cells = np.full_like(grid.cells, OCCUPIED)
    cells[grid.cells == FREE] = FREE
    return OccupancyGrid(cells, grid.resolution, grid.origin)
