"""Bullet's ids of links and joints by their names."""

from dataclasses import dataclass, field
from typing import Dict, List, Optional, Set, Tuple

import numpy as np

from sim_bridge.geometry.pose3 import inverse
from sim_bridge.world import Joint, SurfaceProperties


@dataclass(frozen=True, eq=False)
class BulletLink:
    """A link in Bullet.

    Attributes:
        body_id: Bullet's unique id of the body that the link belongs to.
        link_index: Bullet's index of the link; -1 for the root of the body.
        centre: Pose (4, 4) of the centre of mass and principal axes in the link frame.
        from_centre: Pose (4, 4) of the link frame in that of the centre of mass.
        offset: Position of the link's origin in the frame of the centre of mass, if both have the same
            orientation, else None.
    """

    body_id: int
    link_index: int
    centre: np.ndarray
    from_centre: np.ndarray = field(init=False)
    offset: Optional[Tuple[float, ...]] = field(init=False)

    def __post_init__(self):
        object.__setattr__(self, "from_centre", inverse(self.centre))
        is_turned = bool((self.centre[:3, :3] != np.eye(3)).any())
        offset = None if is_turned else tuple(self.from_centre[:3, 3].tolist())
        object.__setattr__(self, "offset", offset)


@dataclass(frozen=True, eq=False)
class BulletJoint:
    """A movable joint in Bullet.

    Attributes:
        body_id: Bullet's unique id of the multibody.
        link_index: Bullet's index of the child link.
        joint: Description of the joint.
    """

    body_id: int
    link_index: int
    joint: Joint


class BodyRegistry:
    """Maps names of links and movable joints to Bullet's ids, and Bullet's parts back to link names.

    Attributes:
        links: Links by name.
        joints: Movable joints by name.
        dynamic_bodies: Ids of the bodies that are moved by physics.
        surfaces: Contact properties by Bullet's id of the body and index of the link; -1 for the root.
    """

    def __init__(self):
        self.links: Dict[str, BulletLink] = {}
        self.joints: Dict[str, BulletJoint] = {}
        self.dynamic_bodies: Set[int] = set()
        self.surfaces: Dict[Tuple[int, int], SurfaceProperties] = {}
        self._link_names: Dict[Tuple[int, int], str] = {}

    def is_static(self, body_id: int) -> bool:
        """Return whether physics moves no part of a body."""
        return body_id not in self.dynamic_bodies

    def assign_link(self, body_id: int, link_index: int, link: str) -> None:
        """Record which link a Bullet link belongs to; a link with many shapes has several.

        Args:
            body_id: Bullet's unique id of the body.
            link_index: Bullet's index of the link; -1 for the root.
            link: Name of the link, ``model::link``.
        """
        self._link_names[body_id, link_index] = link

    def link_of(self, body_id: int, link_index: int) -> str:
        """Return the name of the link that a Bullet link belongs to.

        Args:
            body_id: Bullet's unique id of the body.
            link_index: Bullet's index of the link; -1 for the root.
        """
        return self._link_names[body_id, link_index]

    def parts_of(self, body_id: int) -> List[int]:
        """Return all link indices of a body."""
        return [link_index for body, link_index in self._link_names if body == body_id]

    def remove(self, body_id: int) -> None:
        """Remove a body with all its links and joints."""
        self.links = {name: link for name, link in self.links.items() if link.body_id != body_id}
        self.joints = {name: joint for name, joint in self.joints.items() if joint.body_id != body_id}
        self._link_names = {part: link for part, link in self._link_names.items() if part[0] != body_id}
        self.surfaces = {part: surface for part, surface in self.surfaces.items() if part[0] != body_id}
        self.dynamic_bodies.discard(body_id)
