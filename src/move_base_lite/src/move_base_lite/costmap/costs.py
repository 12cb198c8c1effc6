"""Values of a costmap's cells, those of costmap_2d."""

import numpy as np

FREE = 0
INSCRIBED = 253
LETHAL = 254
UNKNOWN = 255


def occupancy_of(costs: np.ndarray) -> np.ndarray:
    """Costs as rviz shows them, int8: 0 free, 1..98 inflated, 99 inscribed, 100 lethal, -1 unknown."""
    return _OCCUPANCY_BY_COST[costs]


def _occupancy_by_cost() -> np.ndarray:
    occupancy = np.zeros(256, dtype=np.int8)
    inflated = np.arange(1, INSCRIBED)
    occupancy[1:INSCRIBED] = 1 + (97 * (inflated - 1)) // 251
    occupancy[[INSCRIBED, LETHAL, UNKNOWN]] = 99, 100, -1
    return occupancy


_OCCUPANCY_BY_COST = _occupancy_by_cost()
