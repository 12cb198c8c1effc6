"""The kind ``scan_sparse``."""

from dataclasses import replace
from typing import Optional

import numpy as np

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class SparseScan(FaultKind):
    """Beams get lost."""

    strength = (0.5, 0.0, 1.0)
    unit = "share"

    def scan(self, scan: Scan) -> Optional[Scan]:
        lost = self._rng.random(len(scan.ranges)) < self._strength
        return replace(scan, ranges=np.where(lost, np.nan, scan.ranges).astype(np.float32))
