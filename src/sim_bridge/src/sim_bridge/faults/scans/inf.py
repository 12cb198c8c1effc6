"""The kind ``scan_inf``."""

from dataclasses import replace
from typing import Optional

import numpy as np

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class InfiniteScan(FaultKind):
    """All beams meet nothing."""

    survivable = False

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, ranges=np.full_like(scan.ranges, np.inf))
