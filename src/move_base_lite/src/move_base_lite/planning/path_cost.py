"""What a path costs, to compare those that were planned at different times."""

import math

import numpy as np

from move_base_lite.costmap import INSCRIBED, CostmapWindow
from move_base_lite.planning.wavefront import FACTOR, NEUTRAL


def path_cost(costs: np.ndarray, window: CostmapWindow, path_xy: np.ndarray) -> float:
    """What navfn would pay for a path (N, 2), in neutral metres; inf where it cannot be driven."""
    cells = np.floor((path_xy - (window.origin_x, window.origin_y)) / window.resolution).astype(np.int64)
    below = costs[cells[1:, 1], cells[1:, 0]].astype(float)
    if (below >= INSCRIBED).any():
        return math.inf
    lengths = np.linalg.norm(np.diff(path_xy, axis=0), axis=1)
    return float((lengths * (1.0 + FACTOR / NEUTRAL * below)).sum())
