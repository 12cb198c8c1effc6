"""TITLE: a costmap layer for move_base_lite."""

from dataclasses import dataclass

import numpy as np

from move_base_lite import CostmapWindow, Layer, LayerContext, LayerSettings
from planar.config.parameters import Interval, parameter


@dataclass(frozen=True)
class Settings(LayerSettings):
    """Parameters of its own; in the namespace that plugins names."""

    least: int = parameter(30, "cost of any cell", bounds=Interval(0, 252, "0 to 252"))


class CLASS(Layer):
    """No place is for nothing: short ways count for more."""

    Settings = Settings

    def __init__(self, settings: Settings, site: LayerContext):
        self._least = settings.least

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds) -> None:
        """See move_base_lite.Layer."""
        block = costs[bounds.slices]
        np.maximum(block, self._least, out=block)
