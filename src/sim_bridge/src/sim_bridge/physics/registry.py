"""What has which number in Bullet."""

from dataclasses import dataclass, field
from typing import Dict, List, Optional, Set, Tuple

import numpy as np

from sim_bridge.geometry.pose3 import inverse
from sim_bridge.world import Joint


@dataclass(frozen=True, eq=False)
class BulletLink:
    """A link in Bullet's numbers; ``centre`` (4, 4): of its mass and principal axes in its own frame.

    ``index`` is -1 for the root of what hangs together; ``offset``: from the centre to the link's origin if
    both are turned alike, else None.
    """

    number: int
    index: int
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
    """A joint that is not fixed, in Bullet's numbers."""

    number: int
    index: int
    joint: Joint


class BodyRegistry:
    """Links and moving joints by their names, and whose each of Bullet's parts is.

    ``movers``: numbers of what physics moves.
    """

    def __init__(self):
        self.links: Dict[str, BulletLink] = {}
        self.joints: Dict[str, BulletJoint] = {}
        self.dynamic_bodies: Set[int] = set()
        self._owners: Dict[Tuple[int, int], str] = {}

    def is_static(self, number: int) -> bool:
        """Whether physics moves nothing of what hangs together under a number."""
        return number not in self.dynamic_bodies

    def assign_link(self, number: int, index: int, link: str) -> None:
        """A part of Bullet's belongs to a link; a large one has several."""
        self._owners[number, index] = link

    def link_of(self, number: int, index: int) -> str:
        """The name of the link that a part of Bullet's belongs to."""
        return self._owners[number, index]

    def parts_of(self, number: int) -> List[int]:
        """The indices of all that hangs together under a number."""
        return [index for owned, index in self._owners if owned == number]

    def remove(self, number: int) -> None:
        """All that hangs together under a number is gone."""
        self.links = {name: link for name, link in self.links.items() if link.number != number}
        self.joints = {name: joint for name, joint in self.joints.items() if joint.number != number}
        self._owners = {part: link for part, link in self._owners.items() if part[0] != number}
        self.dynamic_bodies.discard(number)
