"""The kind ``wheel_weak``."""

from typing import Tuple

from sim_bridge.faults.kind import FaultKind


class WeakWheel(FaultKind):
    """The left wheel turns more slowly than it is told."""

    strength = (0.8, 0.0, 1.0)
    unit = "times"

    def wheel_speeds(self, left: float, right: float) -> Tuple[float, float]:
        return left * self._strength, right
