"""The map as a layer of a costmap (costmap_2d's static layer)."""

from dataclasses import dataclass

import numpy as np

from move_base_lite.costmap.costs import FREE, LETHAL, UNKNOWN
from planar.settings import check


@dataclass(frozen=True)
class StaticSettings:
    enabled: bool = True
    map_topic: str = "map"
    track_unknown_space: bool = True
    lethal_cost_threshold: int = 100
    unknown_cost_value: int = -1
    trinary_costmap: bool = True

    def __post_init__(self):
        threshold = self.lethal_cost_threshold
        check(0 < threshold <= 100, "lethal_cost_threshold", "1 to 100", threshold)


def static_costs(cells: np.ndarray, settings: StaticSettings) -> np.ndarray:
    """Costs, uint8 (rows, cols), of a map's cells, int8 (rows, cols)."""
    threshold = settings.lethal_cost_threshold
    if settings.trinary_costmap:
        costs = np.where(cells >= threshold, LETHAL, FREE)
    else:
        costs = np.where(cells >= threshold, LETHAL, LETHAL * cells.astype(np.float64) / threshold)
    unknown = cells == settings.unknown_cost_value
    costs[unknown] = UNKNOWN if settings.track_unknown_space else FREE
    return costs.astype(np.uint8)
