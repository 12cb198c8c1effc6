"""What touches what, and what is below."""

import math
from typing import List, NamedTuple, Optional, Sequence, Tuple

from sim_bridge.physics.bullet import BulletClient
from sim_bridge.physics.registry import BodyRegistry

# Bits of Bullet's collision groups: it puts what moves into 1 and what does not into 2.
WORLD_GROUPS = 1 | 2
ROBOT_GROUP = 4
# How far down a floor is looked for, metres.
DEEPEST_FLOOR = 10.0


class Contact(NamedTuple):
    """Where a robot touches ``link``: the unit normal there, out of it, and how deep they overlap, metres."""

    link: str
    point: Tuple[float, float, float]
    normal: Tuple[float, float, float]
    depth: float


class CollisionQueries:
    """Contacts, and rays cast downwards."""

    def __init__(self, bullet: BulletClient, register: BodyRegistry):
        self._bullet = bullet
        self._register = register

    def contacts(self, base: str, steepest: float = math.inf) -> List[Contact]:
        """What a robot touches, or nearly does (negative depth); abs(normal[2]) is below ``steepest``."""
        return [
            Contact(self._register.link_of(told[2], told[4]), told[6], told[7], -told[8])
            for told in self._bullet.getContactPoints(bodyA=self._register.links[base].number)
            if abs(told[7][2]) < steepest
        ]

    def detect_collisions(self) -> None:
        """Looks for contacts without a step."""
        self._bullet.performCollisionDetection()

    def floor_below(self, x: float, y: float, z: float) -> Optional[float]:
        """The height of the first of the world's bodies below a point, None if there is none."""
        (floor,) = self.floors_below([(x, y, z)])
        return floor if floor > -math.inf else None

    def floors_below(self, points: Sequence[Sequence[float]]) -> List[float]:
        """The heights of what is below points in space, -inf where there is nothing."""
        ends = [(x, y, z - DEEPEST_FLOOR) for x, y, z in points]
        hits = self._bullet.rayTestBatch(points, ends, collisionFilterMask=WORLD_GROUPS)
        return [point[2] if number >= 0 else -math.inf for number, _, _, point, _ in hits]

    def set_robot_filter(self, base: str) -> None:
        """Of what hangs together with a link: it feels the world and other robots, but is no floor."""
        number = self._register.links[base].number
        for index in self._register.parts_of(number):
            self._bullet.setCollisionFilterGroupMask(number, index, ROBOT_GROUP, WORLD_GROUPS | ROBOT_GROUP)
