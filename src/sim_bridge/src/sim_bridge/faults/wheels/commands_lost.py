"""The kind ``commands_lost``."""

from typing import Optional

from planar import Twist2
from sim_bridge.faults.kind import FaultKind


class LostCommands(FaultKind):
    """Commands get lost."""

    strength = (0.3, 0.0, 1.0)
    unit = "share"

    def command(self, twist: Twist2) -> Optional[Twist2]:
        return None if self._rng.random() < self._strength else twist
