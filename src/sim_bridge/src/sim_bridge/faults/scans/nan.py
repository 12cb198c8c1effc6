"""The kind ``scan_nan``."""

from dataclasses import replace
from typing import Optional

import numpy as np

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class NanScan(FaultKind):
    """All beams measure nothing."""

    survivable = False

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, ranges=np.full_like(scan.ranges, np.nan))
