"""The kind ``odometry_stopped``."""

from typing import Optional

from sim_bridge.faults.kind import FaultKind
from sim_bridge.sensors.odometry import Odometry


class StoppedOdometry(FaultKind):
    """Odometry says nothing any more."""

    survivable = False

    def odometry(self, odometry: Odometry) -> Optional[Odometry]:
        return None
