"""Walls that are out of sight: those of the costmap that was planned on, in the one around the robot."""

import math

import numba
import numpy as np

from move_base_lite.control.local_planner import Situation
from move_base_lite.costmap import INSCRIBED, LETHAL
from planar import Pose2

# Of what can be entered.
DEAREST = INSCRIBED - 1


def costs_with_remembered(situation: Situation) -> np.ndarray:
    """The costs around the robot, uint8 (rows, cols), with the walls that only the global costmap knows."""
    window, planned_on = situation.costmap.window, situation.whole.window
    corner = Pose2(window.origin_x, window.origin_y, 0.0)
    corner_in_map = situation.base_in_map @ situation.base_in_local.inverse() @ corner
    return _with_walls(
        situation.costmap.costs,
        situation.whole.costs,
        corner_in_map.x - planned_on.origin_x,
        corner_in_map.y - planned_on.origin_y,
        math.cos(corner_in_map.yaw),
        math.sin(corner_in_map.yaw),
        window.resolution,
        planned_on.resolution,
    )


@numba.njit(cache=True)
def _with_walls(costs, whole, x, y, c, s, cell, cell_of_whole):
    """``costs`` with the walls of ``whole``, in which their corner is at x, y, turned by c and s.

    Close to those it is as dear as can be and not impassable: they may be some centimetres off.
    """
    rows, cols = costs.shape
    both = costs.copy()
    for row in range(rows):
        for col in range(cols):
            along, across = (col + 0.5) * cell, (row + 0.5) * cell
            whole_col = int(math.floor((x + c * along - s * across) / cell_of_whole))
            whole_row = int(math.floor((y + s * along + c * across) / cell_of_whole))
            if not (0 <= whole_row < whole.shape[0] and 0 <= whole_col < whole.shape[1]):
                continue
            cost = whole[whole_row, whole_col]
            if cost == LETHAL:
                both[row, col] = LETHAL
            elif cost < LETHAL and both[row, col] < cost:
                both[row, col] = min(cost, DEAREST)
    return both
