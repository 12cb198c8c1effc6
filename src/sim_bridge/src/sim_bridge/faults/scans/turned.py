"""The kind ``scan_turned``."""

import math
from dataclasses import replace
from typing import Optional

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class TurnedScan(FaultKind):
    """The laser has been knocked, and looks into another direction."""

    strength = (3.0, -180.0, 180.0)
    unit = "degrees"

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, angle_min=scan.angle_min - math.radians(self._strength))
