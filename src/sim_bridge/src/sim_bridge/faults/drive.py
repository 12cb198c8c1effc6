"""Faults of velocity commands and of wheels."""

from collections import deque
from dataclasses import replace
from typing import Deque, Optional, Tuple

import numpy as np

from planar import Twist2
from sim_bridge.faults.kind import FaultKind


class WeakWheel(FaultKind):
    """The left wheel turns more slowly than commanded."""

    strength = (0.8, 0.0, 1.0)
    unit = "times"

    def wheel_speeds(self, left: float, right: float) -> Tuple[float, float]:
        return left * self._strength, right


class StuckWheel(FaultKind):
    """The left wheel does not turn."""

    survivable = False

    def wheel_speeds(self, left: float, right: float) -> Tuple[float, float]:
        return 0.0, right


class BlockedWheels(FaultKind):
    """Neither wheel turns."""

    survivable = False

    def wheel_speeds(self, left: float, right: float) -> Tuple[float, float]:
        return 0.0, 0.0


class LostCommands(FaultKind):
    """Velocity commands are lost."""

    strength = (0.3, 0.0, 1.0)
    unit = "share"

    def command(self, twist: Twist2) -> Optional[Twist2]:
        return None if self._rng.random() < self._strength else twist


class LateCommands(FaultKind):
    """Velocity commands are delayed by a number of commands."""

    strength = (10.0, 0.0, 1000.0)
    unit = "commands"

    def __init__(self, strength: float, rng: np.random.Generator):
        super().__init__(strength, rng)
        self._delayed: Deque[Twist2] = deque()

    def command(self, twist: Twist2) -> Optional[Twist2]:
        self._delayed.append(twist)
        return self._delayed.popleft() if len(self._delayed) > self._strength else None


class SaturatedVelocity(FaultKind):
    """The robot's speed is limited."""

    strength = (0.15, 0.0, 10.0)
    unit = "m/s"

    def command(self, twist: Twist2) -> Optional[Twist2]:
        return replace(twist, v=min(twist.v, self._strength))


class DeafDrive(FaultKind):
    """The drive receives no commands."""

    survivable = False

    def command(self, twist: Twist2) -> Optional[Twist2]:
        return None
