"""TITLE: a costmap layer for move_base_lite."""

from dataclasses import dataclass

import numpy as np

from move_base_lite import CostmapWindow, Layer, LayerContext, LayerSettings
from planar.config.parameters import Interval, parameter


@dataclass(frozen=True)
class Settings(LayerSettings):
    """Parameters, read from the layer's namespace (its name in ``plugins``)."""

    least: int = parameter(30, "minimum cost of a cell", bounds=Interval(0, 252, "0 to 252"))


class CLASS(Layer):
    """Raises all costs to a minimum, so that shorter paths are preferred."""

    Settings = Settings

    def __init__(self, settings: Settings, site: LayerContext):
        self._least = settings.least

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds) -> None:
        """See move_base_lite.Layer."""
        block = costs[bounds.slices]
        np.maximum(block, self._least, out=block)
