"""The kind ``scan_stopped``."""

from typing import Optional

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class StoppedScan(FaultKind):
    """The laser says nothing any more."""

    survivable = False

    def scan(self, scan: Scan) -> Optional[Scan]:
        return None
