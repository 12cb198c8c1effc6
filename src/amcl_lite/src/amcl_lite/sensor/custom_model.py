"""The contract of a user-defined sensor model.

``sensor_plugin: my_package.my_module/MyModel`` selects it instead of ``laser_model_type``.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numba
import numpy as np

from amcl_lite.custom_model import finite_numbers
from amcl_lite.errors import LocalizationError
from planar import OccupancyGrid
from planar.extensions import ExtensionPoint


@dataclass(frozen=True, eq=False)
class Beams:
    """Selected beams of one scan in the base frame.

    Attributes:
        ranges: (N,) [m]; ``max_range`` for beams without return.
        directions: (N,) [rad].
        max_range: Largest range [m].
        start_xy: Position of the laser (2,) [m].
        unmeasured: Number of selected beams that were dropped because they are NaN.
    """

    ranges: np.ndarray
    directions: np.ndarray
    max_range: float
    start_xy: np.ndarray
    unmeasured: int = 0

    @cached_property
    def ends_xy(self) -> np.ndarray:
        """End points (M, 2) of the beams with a return."""
        return _ends(self.ranges, self.directions, self.max_range, self.start_xy)


class SensorModel(Protocol):
    """A sensor model; created for each map and when settings change."""

    def __init__(self, grid: OccupancyGrid, settings: Any): ...

    def log_likelihoods(self, poses: np.ndarray, beams: Beams) -> np.ndarray:
        """Return finite log-likelihoods (N,) of the beams at poses (N, 3) in the map."""
        ...


def _checked(log_likelihoods: Any, poses: np.ndarray, beams: Beams) -> np.ndarray:
    return finite_numbers(log_likelihoods, (len(poses),))


CONTRACT: ExtensionPoint[SensorModel] = ExtensionPoint(
    "sensor model",
    SensorModel,
    "amcl_lite.sensor_models",
    LocalizationError,
    answers={"log_likelihoods": _checked},
)


@numba.njit(cache=True)
def _ends(ranges, directions, max_range, start_xy):
    """Return the end points (M, 2) of beams shorter than ``max_range``."""
    ends_xy, count = np.empty((ranges.size, 2)), 0
    for i in range(ranges.size):
        if ranges[i] < max_range:
            ends_xy[count, 0] = start_xy[0] + ranges[i] * math.cos(directions[i])
            ends_xy[count, 1] = start_xy[1] + ranges[i] * math.sin(directions[i])
            count += 1
    return ends_xy[:count]
