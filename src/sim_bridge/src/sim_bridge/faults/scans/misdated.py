"""The kind ``scan_misdated``."""

from dataclasses import replace
from typing import Optional

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class MisdatedScan(FaultKind):
    """Scans are stamped with another time; more than 0: with one to come."""

    strength = (-0.3, -10.0, 10.0)
    unit = "s"

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, stamp=scan.stamp + self._strength)
