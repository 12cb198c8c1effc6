"""Cost values of a costmap's cells (costmap_2d: cost_values.h)."""

import numpy as np

# The robot's centre can be in the cell.
FREE = 0
# The cell is within the inscribed radius of an obstacle: the robot's centre would collide.
INSCRIBED = 253
# The cell contains an obstacle.
LETHAL = 254
# The cell has not been observed.
UNKNOWN = 255


def occupancy_of(costs: np.ndarray) -> np.ndarray:
    """Convert costs to occupancy values for rviz.

    Args:
        costs: uint8 (rows, cols).

    Returns:
        int8 (rows, cols): 0 free, 1..98 inflated, 99 inscribed, 100 lethal, -1 unknown.
    """
    return _OCCUPANCY_BY_COST[costs]


def _occupancy_by_cost() -> np.ndarray:
    occupancy = np.zeros(256, dtype=np.int8)
    inflated = np.arange(1, INSCRIBED)
    occupancy[1:INSCRIBED] = 1 + (97 * (inflated - 1)) // 251
    occupancy[[INSCRIBED, LETHAL, UNKNOWN]] = 99, 100, -1
    return occupancy


_OCCUPANCY_BY_COST = _occupancy_by_cost()
