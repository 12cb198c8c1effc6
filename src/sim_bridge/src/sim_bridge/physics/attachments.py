"""Temporary fixed constraints between links, as made by a gripper (gazebo_ros_link_attacher)."""

import itertools
from typing import Dict, Optional, Tuple

from sim_bridge.geometry.pose3 import IDENTITY, inverse, position, quaternion
from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.frames import centre_of_mass_of
from sim_bridge.physics.registry import BodyRegistry, BulletLink


class Attachments:
    """Fixed constraints between pairs of links, of which the first holds the second.

    Bullet's constraints do not accept rigid bodies without links. A link that is attached to a static body is
    therefore constrained to the world frame, and the constraint is moved when the static body is.

    Args:
        bullet: The physics engine.
        registry: Bullet's ids of the links.
    """

    def __init__(self, bullet: BulletClient, registry: BodyRegistry):
        self._bullet = bullet
        self._registry = registry
        self._constraints: Dict[Tuple[str, str], Optional[int]] = {}
        # The static link that holds something, by the constraint's id.
        self._anchors: Dict[int, BulletLink] = {}

    def attach(self, first: str, second: str) -> None:
        """Fix two links to each other in their present relative pose; they do not collide while attached.

        Args:
            first: Name of the holding link, ``model::link``.
            second: Name of the held link.
        """
        if (first, second) in self._constraints:
            self.detach(first, second)
        one, other = self._registry.links[first], self._registry.links[second]
        self._constraints[first, second] = self._create_constraint(one, other)
        self._set_collisions_enabled(one, other, False)

    def update(self) -> None:
        """Move the constraints of static bodies to where these bodies are now."""
        for constraint_id, anchor in self._anchors.items():
            pose = centre_of_mass_of(self._bullet, anchor)
            self._bullet.changeConstraint(constraint_id, position(pose), quaternion(pose))

    def _create_constraint(self, one: BulletLink, other: BulletLink) -> Optional[int]:
        """Return the id of a new constraint, None if both links are static."""
        if self._registry.is_static(one.body_id):
            one, other = other, one
        if self._registry.is_static(one.body_id):
            return None
        pose = centre_of_mass_of(self._bullet, other)
        other_in_one = inverse(centre_of_mass_of(self._bullet, one)) @ pose
        is_anchored = self._registry.is_static(other.body_id)
        frame = pose if is_anchored else IDENTITY
        constraint_id = self._bullet.createConstraint(
            one.body_id,
            one.link_index,
            -1 if is_anchored else other.body_id,
            -1 if is_anchored else other.link_index,
            pybullet.JOINT_FIXED,
            [0.0, 0.0, 0.0],
            position(other_in_one),
            position(frame),
            quaternion(other_in_one),
            quaternion(frame),
        )
        if is_anchored:
            self._anchors[constraint_id] = other
        return int(constraint_id)

    def are_attached(self, first: str, second: str) -> bool:
        """Return whether one link holds another.

        Args:
            first: Name of the holding link.
            second: Name of the held link.
        """
        return (first, second) in self._constraints

    def detach(self, first: str, second: str) -> None:
        """Remove the constraint between two links.

        Args:
            first: Name of the holding link.
            second: Name of the held link.

        Raises:
            KeyError: The two are not attached in this order.
        """
        constraint_id = self._constraints.pop((first, second))
        if constraint_id is not None:
            self._bullet.removeConstraint(constraint_id)
            self._anchors.pop(constraint_id, None)
        self._set_collisions_enabled(self._registry.links[first], self._registry.links[second], True)

    def detach_all(self) -> None:
        """Remove all constraints."""
        for pair in list(self._constraints):
            self.detach(*pair)

    def detach_from(self, body_id: int) -> None:
        """Remove all constraints of the links of one Bullet body."""
        for pair in list(self._constraints):
            if body_id in (self._registry.links[link].body_id for link in pair):
                self.detach(*pair)

    def _set_collisions_enabled(self, one: BulletLink, other: BulletLink, enabled: bool) -> None:
        """Enable or disable collisions between all parts of two Bullet bodies."""
        parts = [self._registry.parts_of(link.body_id) for link in (one, other)]
        for first, second in itertools.product(*parts):
            self._bullet.setCollisionFilterPair(one.body_id, other.body_id, first, second, int(enabled))
