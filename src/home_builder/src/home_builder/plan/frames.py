"""Plans in other frames: that of world and map, whose origin is the robot's pose at the start."""

from dataclasses import replace

import numpy as np

from home_builder.plan.model import HomePlan, Point
from planar import Pose2


def plan_in_world(plan: HomePlan) -> HomePlan:
    """Return a plan in the frame of world and map: the robot starts at the origin, facing along x.

    Args:
        plan: A plan in any frame; one that is in this frame already is returned as it is.
    """
    start_in_plan = Pose2(*plan.start, plan.start_yaw)
    return plan if start_in_plan == Pose2() else _transformed(plan, start_in_plan.inverse())


def shifted(plan: HomePlan, x: float, y: float) -> HomePlan:
    """Return a plan that is moved by x and y [m]."""
    return _transformed(plan, Pose2(x, y))


def _transformed(plan: HomePlan, plan_in_frame: Pose2) -> HomePlan:
    def point(at: Point) -> Point:
        ((x, y),) = plan_in_frame.transform_points(np.array([at])).tolist()
        return x, y

    def placed(item):
        x, y = point((item.x, item.y))
        return replace(item, x=x, y=y)

    def turned(item):
        return replace(placed(item), yaw=item.yaw + plan_in_frame.yaw)

    start = plan_in_frame @ Pose2(*plan.start, plan.start_yaw)
    return replace(
        plan,
        walls=tuple(replace(wall, start=point(wall.start), end=point(wall.end)) for wall in plan.walls),
        furniture=tuple(map(turned, plan.furniture)),
        rooms=tuple(map(placed, plan.rooms)),
        places=tuple(map(turned, plan.places)),
        zones=tuple(replace(zone, corners=tuple(map(point, zone.corners))) for zone in plan.zones),
        start=(start.x, start.y),
        start_yaw=start.yaw,
    )
