"""The kind ``odometry_frozen``."""

from typing import Optional

from sim_bridge.faults.kind import FaultKind
from sim_bridge.sensors.odometry import Odometry


class FrozenOdometry(FaultKind):
    """Odometry tells the same place over and over: the encoders are dead."""

    survivable = False

    _kept: Optional[Odometry] = None

    def odometry(self, odometry: Odometry) -> Optional[Odometry]:
        self._kept = self._kept or odometry
        return self._kept
