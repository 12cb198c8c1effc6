"""A local planner whose fault depends on the y of the goal; without a fault it creeps ahead."""

import time

from move_base_lite import Trajectory
from move_base_lite.errors import ControlError
from planar import Twist2

# y of the goal [m] for each fault; map and odometry frame coincide.
FAULTS_BY_GOAL = {0.8: "raises", 1.2: "answers NaN", 1.6: "rushes", 2.4: "dawdles", 2.8: "scribbles"}
CREEP = 0.1


class MisbehavingPlanner:
    def __init__(self, settings, period):
        pass

    def follow(self, context, plan, limits):
        row = min([2.0, *FAULTS_BY_GOAL], key=lambda y: abs(y - plan.path_xy[-1][1]))
        fault, v = FAULTS_BY_GOAL.get(row, ""), CREEP
        if context.costmap.collides(context.base_in_local):
            raise ControlError("it stands in an obstacle")
        if fault == "raises":
            raise ZeroDivisionError("division by zero")
        if fault == "dawdles":
            time.sleep(2.0)
        if fault == "scribbles":
            context.costmap.costs[:] = 0
        v = {"answers NaN": float("nan"), "rushes": 100.0}.get(fault, v)
        return Trajectory(Twist2(v, 0.0), context.base_in_local.as_array()[None, :], 0.0)
