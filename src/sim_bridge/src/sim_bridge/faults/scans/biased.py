"""The kind ``scan_biased``."""

from dataclasses import replace
from typing import Optional

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class BiasedScan(FaultKind):
    """All beams are too long."""

    strength = (0.1, -1.0, 1.0)
    unit = "m"

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, ranges=scan.ranges + scan.ranges.dtype.type(self._strength))
