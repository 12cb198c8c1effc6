"""The kind ``wheel_stuck``."""

from typing import Tuple

from sim_bridge.faults.kind import FaultKind


class StuckWheel(FaultKind):
    """The left wheel does not turn."""

    survivable = False

    def wheel_speeds(self, left: float, right: float) -> Tuple[float, float]:
        return 0.0, right
