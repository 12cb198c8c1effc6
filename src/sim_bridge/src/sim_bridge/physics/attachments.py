"""Links that are held together for a while, as by a gripper."""

import itertools
from typing import Dict, Optional, Tuple

from sim_bridge.geometry.pose3 import IDENTITY, inverse, position, quaternion
from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.frames import centre_of_mass_of
from sim_bridge.physics.registry import BodyRegistry, BulletLink


class Attachments:
    """Pairs of links, the first of which holds the second.

    Bullet cannot hold anything to its rigid bodies: what is held to something that stands is held to the
    world, where that is.
    """

    def __init__(self, bullet: BulletClient, register: BodyRegistry):
        self._bullet = bullet
        self._register = register
        self._constraints: Dict[Tuple[str, str], Optional[int]] = {}
        # What stands and holds something, by the number of the constraint.
        self._anchors: Dict[int, BulletLink] = {}

    def attach(self, first: str, second: str) -> None:
        """Holds two links together as they are now until they are detached; meanwhile they never collide."""
        if (first, second) in self._constraints:
            self.detach(first, second)
        one, other = self._register.links[first], self._register.links[second]
        self._constraints[first, second] = self._create_constraint(one, other)
        self._set_collisions_enabled(one, other, False)

    def update(self) -> None:
        """What is held to something that stands is held to where that is now."""
        for number, anchor in self._anchors.items():
            place = centre_of_mass_of(self._bullet, anchor)
            self._bullet.changeConstraint(number, position(place), quaternion(place))

    def _create_constraint(self, one: BulletLink, other: BulletLink) -> Optional[int]:
        """The number of a new constraint, None if both stand."""
        if self._register.is_static(one.number):
            one, other = other, one
        if self._register.is_static(one.number):
            return None
        place = centre_of_mass_of(self._bullet, other)
        other_in_one = inverse(centre_of_mass_of(self._bullet, one)) @ place
        is_anchored = self._register.is_static(other.number)
        frame = place if is_anchored else IDENTITY
        number = self._bullet.createConstraint(
            one.number,
            one.index,
            -1 if is_anchored else other.number,
            -1 if is_anchored else other.index,
            pybullet.JOINT_FIXED,
            [0.0, 0.0, 0.0],
            position(other_in_one),
            position(frame),
            quaternion(other_in_one),
            quaternion(frame),
        )
        if is_anchored:
            self._anchors[number] = other
        return int(number)

    def are_attached(self, first: str, second: str) -> bool:
        return (first, second) in self._constraints

    def detach(self, first: str, second: str) -> None:
        """Lets go what was attached in this order."""
        number = self._constraints.pop((first, second))
        if number is not None:
            self._bullet.removeConstraint(number)
            self._anchors.pop(number, None)
        self._set_collisions_enabled(self._register.links[first], self._register.links[second], True)

    def detach_all(self) -> None:
        for pair in list(self._constraints):
            self.detach(*pair)

    def detach_from(self, number: int) -> None:
        """Lets go all that is attached to what has that number in Bullet."""
        for pair in list(self._constraints):
            if number in (self._register.links[link].number for link in pair):
                self.detach(*pair)

    def _set_collisions_enabled(self, one: BulletLink, other: BulletLink, may_collide: bool) -> None:
        """All parts of the one with all parts of the other."""
        parts = [self._register.parts_of(link.number) for link in (one, other)]
        for first, second in itertools.product(*parts):
            self._bullet.setCollisionFilterPair(one.number, other.number, first, second, int(may_collide))
