"""Opens and closes doors at their scheduled times."""

import math
from typing import Iterable, Sequence, Tuple

import numpy as np

from planar import Pose2
from sim_bridge.doorway import Door
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.geometry.shapes import Box
from sim_bridge.people.crowd import Crowd, rows_of
from sim_bridge.physics.kinematics import KinematicBodies, Steps
from sim_bridge.robot import Robot
from sim_bridge.world import Body, Collision

# Rate at which doors are updated [Hz].
DOOR_RATE = 10
# Thickness and height of a door, and distance within which it yields to robots and pedestrians [m].
THICKNESS, HEIGHT, CLEARANCE = 0.06, 1.0, 1.0
# Coordinate, out of the world, at which a door is kept while it is open [m].
PARKED = 500.0


class Doors:
    """The doors of a scene: bodies that fill their doorways while closed and are moved away while open.

    A door does not close while a robot is near, and opens for pedestrians.
    """

    def __init__(self, doors: Sequence[Door]):
        self._doors = tuple(doors)
        self._reset()
        self.bodies = tuple(_body_of(door, is_closed) for door, is_closed in zip(doors, self._are_closed))

    def _reset(self) -> None:
        self._are_closed = [bool(door.is_scheduled_closed(np.zeros(1))[0]) for door in self._doors]

    def update(self, engine: KinematicBodies, steps: Steps, robots: Iterable[Robot], crowd: Crowd) -> None:
        """Open and close doors, if due; at time 0 all return to their initial states.

        Args:
            engine: Holds the doors' bodies.
            steps: Physics steps before which they move, in which robots do not.
            robots: The robots.
            crowd: The pedestrians, who have moved before the same steps.
        """
        if not self._doors or not (due := steps.due(DOOR_RATE)):
            return
        stamps = steps.stamps(due)
        if stamps[0] == 0.0:
            self._reset()
        robots_xy, people_xy = rows_of(robots)[:, :2], crowd.positions_before(due)
        for number, door in enumerate(self._doors):
            is_wanted = door.is_scheduled_closed(stamps) & ~_are_near(door, people_xy)
            if _are_near(door, robots_xy):
                is_closed = self._are_closed[number] and bool(is_wanted.all())
            else:
                is_closed = bool(is_wanted[-1])
            self._are_closed[number] = is_closed
            if engine.has_link(door.link):  # it may have been deleted
                engine.set_positions([(door.link, *_position(door, is_closed))])


def _are_near(door: Door, others_xy: np.ndarray) -> np.ndarray:
    """Return (...) whether one of the positions ``others_xy`` (..., N, 2) is close to the closed door."""
    across = np.array((-math.sin(door.pose.yaw), math.cos(door.pose.yaw)))
    off_xy = others_xy - (door.pose.x, door.pose.y)
    along = np.clip(off_xy @ across, -door.width / 2.0, door.width / 2.0)
    off_xy = off_xy - along[..., None] * across
    near: np.ndarray = np.hypot(off_xy[..., 0], off_xy[..., 1]) < CLEARANCE
    return near.any(axis=-1)


def _position(door: Door, is_closed: bool) -> Tuple[float, float]:
    return (door.pose.x, door.pose.y) if is_closed else (PARKED, PARKED)


def _body_of(door: Door, is_closed: bool) -> Body:
    pose = from_pose2(Pose2(*_position(door, is_closed), door.pose.yaw), z=HEIGHT / 2.0)
    solid = Collision(Box((THICKNESS, door.width, HEIGHT)), np.eye(4))
    return Body(door.link, pose, (solid,), is_kinematic=True)
