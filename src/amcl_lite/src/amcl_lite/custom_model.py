"""Loads user-defined sensor and motion models and checks their results."""

import math
from typing import Any, Tuple

import numpy as np

from amcl_lite.errors import LocalizationError
from planar.plugins import PluginContract, errors_raised_as, load_plugin


class CustomModel:
    """A user-defined model whose results are checked and whose errors are reported under its name."""

    def __init__(self, name: str, contract: PluginContract, *given: Any):
        """Create the model. Raises SettingsError for missing methods, LocalizationError if it fails."""
        self._name = name
        make: Any = load_plugin(name, contract)
        with errors_raised_as(name, LocalizationError):
            self._model = make(*given)

    def call(self, method: str, shape: Tuple[int, ...], *given: Any, most: float = math.inf) -> np.ndarray:
        """Call a method and check its result.

        Args:
            method: Name of the method.
            shape: Expected shape of the result.
            given: Arguments of the method.
            most: Largest absolute value.

        Raises:
            LocalizationError: If the method fails or its result has another shape or invalid numbers.
        """
        with errors_raised_as(self._name, LocalizationError):
            result = np.array(getattr(self._model, method)(*given), dtype=float)
        if result.shape != shape or not (np.isfinite(result) & (np.abs(result) <= most)).all():
            up_to = f" up to {most:g}" if most < math.inf else ""
            numbers = " by ".join(map(str, shape))
            raise LocalizationError(f"{self._name} returned no {numbers} finite numbers{up_to}")
        return result
