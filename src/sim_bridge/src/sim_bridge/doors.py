"""Opens and closes doors at their scheduled times."""

import math
from typing import Iterable, Sequence, Tuple

import numpy as np

from planar import Pose2
from sim_bridge.doorway import Door
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.geometry.shapes import Box
from sim_bridge.people.crowd import rows_of
from sim_bridge.physics.kinematics import KinematicBodies
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
        self._are_closed = [door.is_scheduled_closed(0.0) for door in self._doors]

    def update(
        self,
        engine: KinematicBodies,
        step: int,
        rate: int,
        stamp: float,
        robots: Iterable[Robot],
        people: np.ndarray,
    ) -> None:
        """Open and close doors, if due; at time 0 all return to their initial states.

        Args:
            engine: Holds the doors' bodies.
            step: Number of the next physics step.
            rate: Physics steps per second.
            stamp: Simulated time [s].
            robots: The robots.
            people: States (N, 5) of the pedestrians, as ``Crowd.rows``.
        """
        if not self._doors or step % max(rate // DOOR_RATE, 1):
            return
        if stamp == 0.0:
            self._reset()
        robots_xy = rows_of(robots)[:, :2]
        for number, door in enumerate(self._doors):
            may_close = self._are_closed[number] or not _is_near(door, robots_xy)
            is_closed = door.is_scheduled_closed(stamp) and may_close and not _is_near(door, people[:, :2])
            self._are_closed[number] = is_closed
            if engine.has_link(door.link):  # it may have been deleted
                engine.set_positions([(door.link, *_position(door, is_closed))])


def _is_near(door: Door, others_xy: np.ndarray) -> bool:
    """Return whether one of the positions ``others_xy`` (N, 2) is close to the closed door."""
    across = np.array((-math.sin(door.pose.yaw), math.cos(door.pose.yaw)))
    off_xy = others_xy - (door.pose.x, door.pose.y)
    along = np.clip(off_xy @ across, -door.width / 2.0, door.width / 2.0)
    return bool((np.hypot(*(off_xy - along[:, None] * across).T) < CLEARANCE).any())


def _position(door: Door, is_closed: bool) -> Tuple[float, float]:
    return (door.pose.x, door.pose.y) if is_closed else (PARKED, PARKED)


def _body_of(door: Door, is_closed: bool) -> Body:
    pose = from_pose2(Pose2(*_position(door, is_closed), door.pose.yaw), z=HEIGHT / 2.0)
    solid = Collision(Box((THICKNESS, door.width, HEIGHT)), np.eye(4))
    return Body(door.link, pose, (solid,), is_kinematic=True)
