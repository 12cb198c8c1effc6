"""Description of a door."""

import math
from dataclasses import dataclass

import numpy as np

from planar import Pose2
from sim_bridge.errors import WorldError


@dataclass(frozen=True)
class Door:
    """A door that is closed for some time.

    Attributes:
        name: Name of its model.
        pose: Pose of the doorway's centre; its yaw is the direction of passage.
        width: Width of the doorway [m].
        start: Simulated time at which the door closes [s].
        end: Simulated time at which it opens [s].

    Raises:
        WorldError: A value is not valid.
    """

    name: str
    pose: Pose2
    width: float
    start: float = 0.0
    end: float = math.inf

    def __post_init__(self):
        if not (self.pose.is_in_range() and 0.0 < self.width < math.inf and 0.0 <= self.start < self.end):
            raise WorldError(f"{self.name}: a door needs a valid pose, a positive width and 0 <= start < end")

    @property
    def link(self) -> str:
        """Name of its link."""
        return f"{self.name}::link"

    def is_scheduled_closed(self, stamps: np.ndarray) -> np.ndarray:
        """Return (N,) whether the door should be closed at simulated times (N,) [s]."""
        return (self.start <= stamps) & (stamps < self.end)
