"""Static layer: the map (costmap_2d: StaticLayer)."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from move_base_lite.costmap.costs import FREE, LETHAL, UNKNOWN
from move_base_lite.costmap.layer import CostmapPlacement, Layer, LayerContext, LayerSettings
from move_base_lite.costmap.resampling import resample_costs
from move_base_lite.costmap.window import NO_CELLS, CellBounds, CostmapWindow
from planar.config.parameters import Interval as ParameterBounds
from planar.config.parameters import check_parameters, parameter
from planar.extensions import Plugin


@dataclass(frozen=True)
class StaticSettings(LayerSettings):
    """Parameters of costmap_2d's static layer."""

    map_topic: str = parameter("map", "topic of the map")
    track_unknown_space: bool = parameter(
        True, "whether the map's unknown cells are unknown rather than free"
    )
    lethal_cost_threshold: int = parameter(
        100, "occupancy from which on a cell is an obstacle", bounds=ParameterBounds(1, 100, "1 to 100")
    )
    unknown_cost_value: int = parameter(-1, "occupancy of unknown cells")
    trinary_costmap: bool = parameter(
        True, "whether cells are obstacle, free or unknown, without values in between"
    )

    def __post_init__(self):
        check_parameters(self)


class StaticLayer(Layer):
    """Writes the map into a fixed costmap, or resamples it into a rolling window."""

    def __init__(self, settings: StaticSettings, context: LayerContext):
        self._grid, self._is_rolling = context.grid, context.is_rolling
        self._costs: Optional[np.ndarray] = None
        if context.grid is not None:
            self._map_costs = static_costs(context.grid.cells, settings)
            if not context.is_rolling:
                self._costs = self._map_costs

    def update(self, placement: CostmapPlacement) -> CellBounds:
        if self._grid is None or not self._is_rolling:
            return NO_CELLS
        window, frame_in_map, grid = placement.window, placement.map_in_frame.inverse(), self._grid
        self._costs = resample_costs(window, frame_in_map, self._map_costs, grid.origin, grid.resolution)
        return window.everything

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds: CellBounds) -> None:
        if self._costs is not None:
            rows, cols = bounds.slices
            costs[rows, cols] = self._costs[rows, cols]


def static_costs(cells: np.ndarray, settings: StaticSettings) -> np.ndarray:
    """Convert occupancy values of a map to costs.

    Args:
        cells: int8 (rows, cols), 0 to 100, or -1 for unknown.
        settings: Thresholds of the static layer.

    Returns:
        uint8 (rows, cols).
    """
    threshold = settings.lethal_cost_threshold
    if settings.trinary_costmap:
        costs = np.where(cells >= threshold, LETHAL, FREE)
    else:
        costs = np.where(cells >= threshold, LETHAL, LETHAL * cells.astype(np.float64) / threshold)
    unknown = cells == settings.unknown_cost_value
    costs[unknown] = UNKNOWN if settings.track_unknown_space else FREE
    return costs.astype(np.uint8)


STATIC: Plugin[Layer] = Plugin(
    "costmap_2d::StaticLayer",
    StaticSettings,
    StaticLayer,
    ignored=frozenset({"first_map_only", "subscribe_to_updates", "use_maximum"}),
)
