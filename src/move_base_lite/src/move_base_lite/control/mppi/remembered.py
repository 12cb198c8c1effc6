"""Walls that are out of sight: those of the costmap that was planned on, in the one around the robot."""

import numpy as np

from move_base_lite.control.local_planner import Situation
from move_base_lite.costmap import INSCRIBED, LETHAL
from move_base_lite.costmap.resampling import resample_costs
from planar import Pose2

# Of what can be entered.
DEAREST = INSCRIBED - 1


def costs_with_remembered(situation: Situation) -> np.ndarray:
    """The costs around the robot, uint8 (rows, cols), with the walls that only the global costmap knows.

    Close to those it is as dear as can be and not impassable: they may be some centimetres off.
    """
    near, whole = situation.costmap, situation.whole.window
    local_in_map = situation.base_in_map @ situation.base_in_local.inverse()
    origin = Pose2(whole.origin_x, whole.origin_y)
    known = resample_costs(near.window, local_in_map, situation.whole.costs, origin, whole.resolution)
    both = np.where(known < LETHAL, np.maximum(near.costs, np.minimum(known, DEAREST)), near.costs)
    both[known == LETHAL] = LETHAL
    return both
