"""The kind ``scan_masked``."""

from dataclasses import replace
from typing import Optional

import numpy as np

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class MaskedScan(FaultKind):
    """Something stuck to the robot hides a sector ahead to the left."""

    strength = (1.0, 0.0, 6.3)
    unit = "rad"

    def scan(self, scan: Scan) -> Optional[Scan]:
        ranges = scan.ranges.copy()
        ranges[(scan.angles > 0.0) & (scan.angles < self._strength)] = np.nan
        return replace(scan, ranges=ranges)
