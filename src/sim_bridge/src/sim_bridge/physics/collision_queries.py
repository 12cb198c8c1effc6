"""Contacts and downward ray casts."""

import math
from typing import List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from sim_bridge.physics.bullet import BulletClient
from sim_bridge.physics.registry import BodyRegistry

# Bullet's collision filter groups: 1 for dynamic bodies, 2 for static ones.
WORLD_GROUPS = 1 | 2
ROBOT_GROUP = 4
# Depth to which a floor is searched [m].
FLOOR_SEARCH_DEPTH = 10.0
# Bullet's largest number of rays in one call.
RAY_BATCH = 16383
# Surfaces of the excluded body that a ray may pass, and the distance that it skips behind each [m].
MAX_PASSES, PASSED_SURFACE = 16, 1e-4


class Contact(NamedTuple):
    """A contact of a robot.

    Attributes:
        link: Name of the other link.
        point: Position (3,) on the robot, in the world frame [m].
        normal: Unit normal (3,) at the contact, in the world frame, pointing away from ``link``.
        depth: Penetration depth [m]; negative if the two are close but do not touch.
    """

    link: str
    point: Tuple[float, float, float]
    normal: Tuple[float, float, float]
    depth: float


class CollisionQueries:
    """Queries of contacts and of the floor height."""

    def __init__(self, bullet: BulletClient, registry: BodyRegistry):
        self._bullet = bullet
        self._registry = registry

    def contacts(self, base: str, max_normal_z: float = math.inf) -> List[Contact]:
        """Return the contacts of a robot, as of the last physics step or ``detect_collisions``.

        Args:
            base: Name of the robot's base link.
            max_normal_z: Contacts whose normal has an absolute z component of at least this are left out.
        """
        return [
            Contact(self._registry.link_of(point[2], point[4]), point[6], point[7], -point[8])
            for point in self._bullet.getContactPoints(bodyA=self._registry.links[base].body_id)
            if abs(point[7][2]) < max_normal_z
        ]

    def detect_collisions(self) -> None:
        """Update the contacts without a physics step."""
        self._bullet.performCollisionDetection()

    def floor_below(self, x: float, y: float, z: float) -> Optional[float]:
        """Return the height of the nearest body of the world below a point.

        Args:
            x: Position of the point in the world [m].
            y: Position of the point in the world [m].
            z: Height of the point [m].

        Returns:
            The height [m]; None if there is no body.
        """
        (floor,) = self.floors_below([(x, y, z)])
        return floor if floor > -math.inf else None

    def floors_below(self, points: Sequence[Sequence[float]]) -> List[float]:
        """Return the height of the floor below each of several points.

        Args:
            points: Points (N, 3) in the world [m].

        Returns:
            The heights (N,) [m]; -inf where there is no floor.
        """
        ends = [(x, y, z - FLOOR_SEARCH_DEPTH) for x, y, z in points]
        hits = self._bullet.rayTestBatch(points, ends, collisionFilterMask=WORLD_GROUPS)
        return [point[2] if body_id >= 0 else -math.inf for body_id, _, _, point, _ in hits]

    def cast_rays(
        self, origin: np.ndarray, directions: np.ndarray, max_range: float, excluded: str
    ) -> Tuple[np.ndarray, List[str]]:
        """Cast rays in space.

        Args:
            origin: Start (3,) of the rays in the world [m].
            directions: Unit vectors (N, 3) in the world.
            max_range: Largest range [m].
            excluded: Name of a link of the body that rays pass through.

        Returns:
            The length (N,) of each ray [m], infinite without a hit, and the name of the link that it hits,
            empty if there is none.
        """
        excluded_id = self._registry.links[excluded].body_id
        lengths, links = np.full(len(directions), np.inf), [""] * len(directions)
        passed = np.zeros(len(directions))
        pending = np.arange(len(directions))
        for _ in range(MAX_PASSES):
            if not pending.size:
                break
            starts = origin + passed[pending, None] * directions[pending]
            hits = self._ray_hits(starts, origin + max_range * directions[pending])
            inside = []
            for ray, (body_id, link_index, fraction, *_) in zip(pending.tolist(), hits):
                length = passed[ray] + fraction * (max_range - passed[ray])
                if body_id == excluded_id:
                    passed[ray] = length + PASSED_SURFACE
                    inside.append(ray)
                elif body_id >= 0:
                    lengths[ray], links[ray] = length, self._registry.link_of(body_id, link_index)
            pending = np.array([ray for ray in inside if passed[ray] < max_range], dtype=int)
        return lengths, links

    def _ray_hits(self, starts: np.ndarray, ends: np.ndarray) -> List[Tuple]:
        """Return Bullet's hit of each ray, in batches of its largest size."""
        hits: List[Tuple] = []
        for at in range(0, len(starts), RAY_BATCH):
            batch = slice(at, at + RAY_BATCH)
            hits += self._bullet.rayTestBatch(
                starts[batch].tolist(), ends[batch].tolist(), collisionFilterMask=WORLD_GROUPS | ROBOT_GROUP
            )
        return hits

    def set_robot_filter(self, base: str) -> None:
        """Set a robot's collision filter: it collides with the world and other robots, but is no floor.

        Args:
            base: Name of the robot's base link.
        """
        body_id = self._registry.links[base].body_id
        for link_index in self._registry.parts_of(body_id):
            self._bullet.setCollisionFilterGroupMask(
                body_id, link_index, ROBOT_GROUP, WORLD_GROUPS | ROBOT_GROUP
            )
