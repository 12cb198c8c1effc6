"""The kind ``scan_zero``."""

from dataclasses import replace
from typing import Optional

import numpy as np

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class ZeroScan(FaultKind):
    """All beams meet something at once, as with a covered lens."""

    survivable = False

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, ranges=np.full_like(scan.ranges, 0.0))
