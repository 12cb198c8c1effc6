"""The contract of a sensor model of somebody's own, and the guard that stands before it.

It is chosen by ``sensor_plugin: my_package.my_module/MyModel`` and takes the place of ``laser_model_type``.
"""

from typing import Protocol

import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.errors import LocalizationError
from amcl_lite.sensor.beams import Beams
from planar import OccupancyGrid, SettingsError
from planar.plugins import Contract, load


class SensorModel(Protocol):
    """Made for each map and whenever settings change."""

    def __init__(self, grid: OccupancyGrid, settings: LocalizerSettings): ...

    def log_likelihoods(self, poses: np.ndarray, beams: Beams) -> np.ndarray:
        """Natural logarithms (N,), finite, of how likely the beams are at poses (N, 3) in the map."""
        ...


CONTRACT = Contract("sensor model", SensorModel, LocalizerSettings, "amcl_lite.sensor_models")


class GuardedSensorModel:
    """One of other people: what it gives is checked, what goes wrong in it is its fault."""

    def __init__(self, name: str, grid: OccupancyGrid, settings: LocalizerSettings):
        """Raises SettingsError with what it lacks, LocalizationError if it cannot be made."""
        self._name = name
        make = load(name, CONTRACT)
        try:
            self._model: SensorModel = make(grid, settings)  # type: ignore[misc]
        except Exception as error:
            raise self._fault(f"raised {type(error).__name__}: {error}") from error

    def log_likelihoods(self, poses: np.ndarray, beams: Beams) -> np.ndarray:
        """Raises LocalizationError."""
        try:
            told = np.asarray(self._model.log_likelihoods(poses.copy(), beams), dtype=float)
        except Exception as error:
            raise self._fault(f"raised {type(error).__name__}: {error}") from error
        if told.shape != (len(poses),) or not np.isfinite(told).all():
            raise self._fault(f"gave no {len(poses)} finite numbers")
        return told

    def _fault(self, text: str) -> LocalizationError:
        return LocalizationError(f"{self._name} {text}")


def check_name(name: str) -> None:
    """Raises SettingsError if there is no such sensor model, or with what it lacks."""
    if load(name, CONTRACT) is None:
        raise SettingsError(f"sensor_plugin must be like my_package.my_module/MyModel, got {name!r}")
