"""Pose and velocity of frames, the contract of bodies that scripts move, and the steps at which they do."""

from dataclasses import dataclass
from functools import cached_property
from typing import Iterable, NamedTuple, Protocol, Tuple

import numpy as np

from planar import Pose2
from sim_bridge.geometry.pose3 import cross, to_pose2


@dataclass(frozen=True, eq=False)
class KinematicState:
    """Pose and velocity of a frame, in the world frame (as gazebo_msgs/LinkState).

    Attributes:
        pose: Pose (4, 4).
        linear: Velocity (3,) of the frame's origin [m/s].
        angular: Angular velocity (3,) [rad/s].
    """

    pose: np.ndarray
    linear: np.ndarray
    angular: np.ndarray

    @cached_property
    def pose2(self) -> Pose2:
        """The pose in the plane: x, y and yaw."""
        return to_pose2(self.pose)

    def is_moving(self, speed: float) -> bool:
        """Return whether the frame moves along or about an axis faster than ``speed`` [m/s and rad/s]."""
        return bool(max(np.abs(self.linear).max(), np.abs(self.angular).max()) > speed)

    def of_frame(self, frame_in_this: np.ndarray) -> "KinematicState":
        """Return the state of a frame that is fixed to this one.

        Args:
            frame_in_this: Pose (4, 4) of that frame in this one.
        """
        return self.at(self.pose @ frame_in_this)

    def at(self, pose: np.ndarray) -> "KinematicState":
        """Return the state of a frame that is rigidly attached to this one.

        Args:
            pose: Pose (4, 4) of that frame in the world.
        """
        arm = pose[:3, 3] - self.pose[:3, 3]
        return KinematicState(pose, self.linear + cross(self.angular, arm), self.angular)


def at_rest(pose: np.ndarray) -> KinematicState:
    """Return the state of a frame at rest at ``pose`` (4, 4) in the world."""
    return KinematicState(pose, np.zeros(3), np.zeros(3))


class KinematicBodies(Protocol):
    """Bodies that are moved by a script, not by physics; the engine implements it."""

    def has_link(self, name: str) -> bool:
        """Return whether there is a link of this name."""

    def set_positions(self, positions: Iterable[Tuple[str, float, float]]) -> None:
        """Move bodies to positions in the plane.

        Args:
            positions: Link name, x and y in the world frame [m] of each body.
        """


class Steps(NamedTuple):
    """Consecutive physics steps.

    Attributes:
        first: Number of the first step since the rate was set.
        end: Number of the step after the last.
        rate: Physics steps per second.
        origin: Simulated time at which the rate was set [s].
    """

    first: int
    end: int
    rate: int
    origin: float

    def due(self, rate: int) -> range:
        """Return the steps at which something is due that happens ``rate`` times per second [Hz]."""
        every = interval(self.rate, rate)
        return range(-(-self.first // every) * every, self.end, every)

    def stamps(self, steps: range) -> np.ndarray:
        """Return the simulated time (N,) of steps [s]."""
        return self.origin + np.arange(steps.start, steps.stop, steps.step) / self.rate


def interval(physics_rate: int, rate: int) -> int:
    """Return the number of physics steps between two of ``rate`` events per second [Hz]."""
    return max(physics_rate // rate, 1)
