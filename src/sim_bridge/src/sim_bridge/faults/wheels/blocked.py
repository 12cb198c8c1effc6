"""The kind ``wheels_blocked``."""

from typing import Tuple

from sim_bridge.faults.kind import FaultKind


class BlockedWheels(FaultKind):
    """Neither wheel turns."""

    survivable = False

    def wheel_speeds(self, left: float, right: float) -> Tuple[float, float]:
        return 0.0, 0.0
