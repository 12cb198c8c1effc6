"""What stands before a model of somebody's own, of a sensor or of motion."""

import math
from typing import Any, Tuple

import numpy as np

from amcl_lite.errors import LocalizationError
from planar.plugins import PluginContract, errors_raised_as, load_plugin


class CustomModel:
    """What it gives is checked, what goes wrong in it is its fault."""

    def __init__(self, name: str, contract: PluginContract, *given: Any):
        """Raises SettingsError with what it lacks, LocalizationError if it cannot be made."""
        self._name = name
        make: Any = load_plugin(name, contract)
        with errors_raised_as(name, LocalizationError):
            self._model = make(*given)

    def call(self, method: str, shape: Tuple[int, ...], *given: Any, most: float = math.inf) -> np.ndarray:
        """Its answer, finite numbers of that shape, none larger than ``most``. Raises LocalizationError."""
        with errors_raised_as(self._name, LocalizationError):
            result = np.array(getattr(self._model, method)(*given), dtype=float)
        if result.shape != shape or not (np.isfinite(result) & (np.abs(result) <= most)).all():
            up_to = f" up to {most:g}" if most < math.inf else ""
            numbers = " by ".join(map(str, shape))
            raise LocalizationError(f"{self._name} gave no {numbers} finite numbers{up_to}")
        return result
