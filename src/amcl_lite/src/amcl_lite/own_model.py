"""What stands before a model of somebody's own, of a sensor or of motion."""

import math
from typing import Any, Tuple

import numpy as np

from amcl_lite.errors import LocalizationError
from planar import SettingsError
from planar.plugins import Contract, load


class OwnModel:
    """What it gives is checked, what goes wrong in it is its fault."""

    def __init__(self, name: str, contract: Contract, *given: Any):
        """Raises SettingsError with what it lacks, LocalizationError if it cannot be made."""
        self._name = name
        make: Any = load(name, contract)
        try:
            self._model = make(*given)
        except Exception as error:
            raise self._fault(f"raised {type(error).__name__}: {error}") from error

    def ask(self, method: str, shape: Tuple[int, ...], *given: Any, most: float = math.inf) -> np.ndarray:
        """Its answer, finite numbers of that shape, none larger than ``most``. Raises LocalizationError."""
        try:
            told = np.array(getattr(self._model, method)(*given), dtype=float)
        except Exception as error:
            raise self._fault(f"raised {type(error).__name__}: {error}") from error
        if told.shape != shape or not (np.isfinite(told) & (np.abs(told) <= most)).all():
            up_to = f" up to {most:g}" if most < math.inf else ""
            raise self._fault(f"gave no {' by '.join(map(str, shape))} finite numbers{up_to}")
        return told

    def _fault(self, text: str) -> LocalizationError:
        return LocalizationError(f"{self._name} {text}")


def check_name(parameter: str, name: str, contract: Contract) -> None:
    """Raises SettingsError if there is no such class, or with what it lacks."""
    if load(name, contract) is None:
        raise SettingsError(f"{parameter} must be like my_package.my_module/MyModel, got {name!r}")
