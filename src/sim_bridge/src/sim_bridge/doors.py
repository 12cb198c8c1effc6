"""Doors that are shut for a time, as somebody does it who does not ask the robot."""

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

# Times a second that doors are looked after.
DOOR_RATE = 10
# Metres: thickness and height of a door, from it to whom it waits for, and where it is while it is open.
THICKNESS, HEIGHT, NEAR = 0.06, 1.0, 1.0
AWAY = 500.0


class Doors:
    """Bodies that fill their doorways while they are shut, and are out of the world while they are open.

    None shuts while a robot is near, and one that is shut opens to people, who have hands.
    """

    def __init__(self, each: Sequence[Door]):
        self._each = tuple(each)
        self._begin()
        self.bodies = tuple(_body_of(door, is_shut) for door, is_shut in zip(each, self._are_shut))

    def _begin(self) -> None:
        self._are_shut = [door.is_due(0.0) for door in self._each]

    def update(
        self,
        engine: KinematicBodies,
        step: int,
        rate: int,
        stamp: float,
        robots: Iterable[Robot],
        people: np.ndarray,
    ) -> None:
        """Before the step of physics number ``step``, of ``rate`` a second, which begins at ``stamp``.

        ``people``: (N, 5), as sim_bridge.people.crowd has them. At time 0 all begin anew.
        """
        if not self._each or step % max(rate // DOOR_RATE, 1):
            return
        if stamp == 0.0:
            self._begin()
        robots_xy = rows_of(robots)[:, :2]
        for number, door in enumerate(self._each):
            may_shut = self._are_shut[number] or not _is_near(door, robots_xy)
            is_shut = door.is_due(stamp) and may_shut and not _is_near(door, people[:, :2])
            self._are_shut[number] = is_shut
            if engine.has_link(door.link):  # nobody has taken it away
                engine.set_positions([(door.link, *_place(door, is_shut))])


def _is_near(door: Door, others_xy: np.ndarray) -> bool:
    """Whether one of others (N, 2) is where the door would touch it, or soon will be."""
    across = np.array((-math.sin(door.pose.yaw), math.cos(door.pose.yaw)))
    off_xy = others_xy - (door.pose.x, door.pose.y)
    along = np.clip(off_xy @ across, -door.width / 2.0, door.width / 2.0)
    return bool((np.hypot(*(off_xy - along[:, None] * across).T) < NEAR).any())


def _place(door: Door, is_shut: bool) -> Tuple[float, float]:
    return (door.pose.x, door.pose.y) if is_shut else (AWAY, AWAY)


def _body_of(door: Door, is_shut: bool) -> Body:
    pose = from_pose2(Pose2(*_place(door, is_shut), door.pose.yaw), z=HEIGHT / 2.0)
    solid = Collision(Box((THICKNESS, door.width, HEIGHT)), np.eye(4))
    return Body(door.link, pose, (solid,), is_kinematic=True)
