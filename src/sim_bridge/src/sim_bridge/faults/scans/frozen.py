"""The kind ``scan_frozen``."""

from dataclasses import replace
from typing import Optional

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class FrozenScan(FaultKind):
    """The laser tells the same scan over and over, with fresh stamps."""

    survivable = False

    _kept: Optional[Scan] = None

    def scan(self, scan: Scan) -> Optional[Scan]:
        self._kept = self._kept or scan
        return replace(self._kept, stamp=scan.stamp)
