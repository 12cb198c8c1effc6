"""The contract of a sensor model of somebody's own, and what stands before it.

It is chosen by ``sensor_plugin: my_package.my_module/MyModel`` and takes the place of ``laser_model_type``.
"""

from typing import Protocol

import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.custom_model import CustomModel
from amcl_lite.sensor.beams import Beams
from planar import OccupancyGrid
from planar.plugins import PluginContract


class SensorModel(Protocol):
    """Made for each map and whenever settings change."""

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings): ...

    def log_likelihoods(self, poses: np.ndarray, beams: Beams) -> np.ndarray:
        """Natural logarithms (N,), finite, of how likely the beams are at poses (N, 3) in the map."""
        ...


CONTRACT = PluginContract("sensor model", SensorModel, LocalizerSettings, "amcl_lite.sensor_models")


class CustomSensorModel:
    """One of other people: what it gives is checked, what goes wrong in it is its fault."""

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings):
        """Raises LocalizationError if it cannot be made."""
        self._custom = CustomModel(settings.sensor_plugin, CONTRACT, grid, settings)

    def log_likelihoods(self, poses: np.ndarray, beams: Beams) -> np.ndarray:
        """Raises LocalizationError."""
        return self._custom.call("log_likelihoods", (len(poses),), poses.copy(), beams)
