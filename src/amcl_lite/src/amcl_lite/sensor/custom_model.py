"""The contract of a user-defined sensor model.

``sensor_plugin: my_package.my_module/MyModel`` selects it instead of ``laser_model_type``.
"""

from typing import Protocol

import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.custom_model import CustomModel
from amcl_lite.sensor.beams import Beams
from planar import OccupancyGrid
from planar.plugins import PluginContract


class SensorModel(Protocol):
    """A sensor model; created for each map and when settings change."""

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings): ...

    def log_likelihoods(self, poses: np.ndarray, beams: Beams) -> np.ndarray:
        """Return finite log-likelihoods (N,) of the beams at poses (N, 3) in the map."""
        ...


CONTRACT = PluginContract("sensor model", SensorModel, LocalizerSettings, "amcl_lite.sensor_models")


class CustomSensorModel:
    """A user-defined sensor model whose results are checked."""

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings):
        """Create the model. Raises LocalizationError if that fails."""
        self._custom = CustomModel(settings.sensor_plugin, CONTRACT, grid, settings)

    def log_likelihoods(self, poses: np.ndarray, beams: Beams) -> np.ndarray:
        """Raises LocalizationError."""
        return self._custom.call("log_likelihoods", (len(poses),), poses.copy(), beams)
