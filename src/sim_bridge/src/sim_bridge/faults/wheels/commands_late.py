"""The kind ``commands_late``."""

from collections import deque
from typing import Deque, Optional

import numpy as np

from planar import Twist2
from sim_bridge.faults.kind import FaultKind


class LateCommands(FaultKind):
    """Commands come so many commands later."""

    strength = (10.0, 0.0, 1000.0)
    unit = "commands"

    def __init__(self, strength: float, rng: np.random.Generator):
        super().__init__(strength, rng)
        self._waiting: Deque[Twist2] = deque()

    def command(self, twist: Twist2) -> Optional[Twist2]:
        self._waiting.append(twist)
        return self._waiting.popleft() if len(self._waiting) > self._strength else None
