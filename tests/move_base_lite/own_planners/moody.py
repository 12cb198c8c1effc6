"""A local planner that misbehaves as the goal's row in the map says, and otherwise creeps ahead."""

import time

from move_base_lite import Trajectory
from move_base_lite.errors import ControlError
from planar import Twist2

# Metres: where the goal of each misdeed lies along y; the map is seen from odom without an offset.
MISDEEDS = {0.8: "raises", 1.2: "answers NaN", 1.6: "rushes", 2.4: "dawdles", 2.8: "scribbles"}
CREEP = 0.1


class Moody:
    def __init__(self, settings, period):
        pass

    def follow(self, context, plan, limits):
        row = min([2.0, *MISDEEDS], key=lambda y: abs(y - plan.path_xy[-1][1]))
        misdeed, v = MISDEEDS.get(row, ""), CREEP
        if context.costmap.collides(context.base_in_local):
            raise ControlError("it stands in an obstacle")
        if misdeed == "raises":
            raise ZeroDivisionError("division by zero")
        if misdeed == "dawdles":
            time.sleep(2.0)
        if misdeed == "scribbles":
            context.costmap.costs[:] = 0
        v = {"answers NaN": float("nan"), "rushes": 100.0}.get(misdeed, v)
        return Trajectory(Twist2(v, 0.0), context.base_in_local.as_array()[None, :], 0.0)
