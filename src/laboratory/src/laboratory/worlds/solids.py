"""Building blocks of worlds: floor, walls and posts."""

import numpy as np

from planar import Pose2
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.geometry.shapes import Cylinder, Plane
from sim_bridge.simulation import box_on_floor
from sim_bridge.world import Body, Collision

FLOOR = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
WALL_HEIGHT = 1.0


def wall(name: str, x: float, y: float, width: float, depth: float) -> Body:
    """Return an axis-aligned wall centred at (x, y) [m]."""
    return box_on_floor(name, (width, depth, WALL_HEIGHT), Pose2(x, y))


def post(name: str, place: Pose2, radius: float, height: float, is_kinematic: bool = False) -> Body:
    """Return a cylinder that stands on the floor [m]."""
    solid = (Collision(Cylinder(radius, height), np.eye(4)),)
    return Body(f"{name}::link", from_pose2(place, z=height / 2.0), solid, is_kinematic=is_kinematic)
