"""A door, as data."""

import math
from dataclasses import dataclass

from planar import Pose2
from sim_bridge.errors import WorldError


@dataclass(frozen=True)
class Door:
    """The door ``name`` in a doorway ``width`` metres wide, which one goes through along the yaw of ``pose``.

    It is shut from ``start`` to ``end``, seconds of simulated time.
    """

    name: str
    pose: Pose2
    width: float
    start: float = 0.0
    end: float = math.inf

    def __post_init__(self):
        if not (self.pose.is_in_range() and 0.0 < self.width < math.inf and 0.0 <= self.start < self.end):
            raise WorldError(
                f"{self.name}: a door needs a place, a positive width, and to end after its start"
            )

    @property
    def link(self) -> str:
        return f"{self.name}::link"

    def is_due(self, stamp: float) -> bool:
        """Whether it is to be shut."""
        return self.start <= stamp < self.end
