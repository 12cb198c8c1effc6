"""Where things are and how they move."""

from dataclasses import dataclass
from functools import cached_property
from typing import Iterable, Protocol, Tuple

import numpy as np

from planar import Pose2
from sim_bridge.geometry.pose3 import cross, to_pose2


@dataclass(frozen=True, eq=False)
class KinematicState:
    """Where a frame is and how it moves: ``pose`` (4, 4), velocities ``linear`` and ``angular`` (3,).

    All in the world; the velocity is that of the frame's origin.
    """

    pose: np.ndarray
    linear: np.ndarray
    angular: np.ndarray

    @cached_property
    def pose2(self) -> Pose2:
        """Where the frame is, seen from above."""
        return to_pose2(self.pose)

    def of_frame(self, frame_in_this: np.ndarray) -> "KinematicState":
        """The motion of a frame that is fixed at ``frame_in_this`` (4, 4)."""
        return self.at(self.pose @ frame_in_this)

    def at(self, pose: np.ndarray) -> "KinematicState":
        """The motion of a frame that moves along with this one and now is at ``pose`` (4, 4) in the world."""
        arm = pose[:3, 3] - self.pose[:3, 3]
        return KinematicState(pose, self.linear + cross(self.angular, arm), self.angular)


def at_rest(pose: np.ndarray) -> KinematicState:
    """The frame at ``pose``, (4, 4) in the world, stands still."""
    return KinematicState(pose, np.zeros(3), np.zeros(3))


class KinematicBodies(Protocol):
    """Bodies that are moved by a script, not by physics; the engine implements it."""

    def has_link(self, name: str) -> bool:
        """Return whether the link ``name`` exists."""

    def set_positions(self, positions: Iterable[Tuple[str, float, float]]) -> None:
        """Move bodies to positions in the plane.

        Args:
            positions: Link name, x and y in the world frame [m] of each body.
        """
