"""A drive as data."""

import math
from dataclasses import dataclass
from typing import Tuple


@dataclass(frozen=True)
class DriveProfile:
    """Driven wheels on both sides: radius and separation in metres, torque in N m, limits in SI units.

    The robot stops when no command has come for ``command_timeout`` seconds.
    """

    left_joints: Tuple[str, ...]
    right_joints: Tuple[str, ...]
    wheel_radius: float
    wheel_separation: float
    torque: float
    command_topics: Tuple[str, ...] = ("cmd_vel",)
    max_speed: float = math.inf
    max_turn_rate: float = math.inf
    max_acceleration: float = math.inf
    max_turn_acceleration: float = math.inf
    command_timeout: float = math.inf

    @property
    def joints(self) -> Tuple[str, ...]:
        """Of all driven wheels, those on the left first."""
        return self.left_joints + self.right_joints
