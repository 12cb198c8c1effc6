"""The kind ``velocity_saturated``."""

from typing import Optional

from planar import Twist2
from sim_bridge.faults.kind import FaultKind


class SaturatedVelocity(FaultKind):
    """The robot is no faster than this."""

    strength = (0.15, 0.0, 10.0)
    unit = "m/s"

    def command(self, twist: Twist2) -> Optional[Twist2]:
        return Twist2(min(twist.v, self._strength), twist.omega)
