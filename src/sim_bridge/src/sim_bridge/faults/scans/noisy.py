"""The kind ``scan_noisy``."""

from dataclasses import replace
from typing import Optional

import numpy as np

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class NoisyScan(FaultKind):
    """Beams are noisier than they should be."""

    strength = (0.06, 0.0, 5.0)
    unit = "m"

    def scan(self, scan: Scan) -> Optional[Scan]:
        noise = self._rng.normal(0.0, self._strength, len(scan.ranges))
        return replace(scan, ranges=np.maximum(scan.ranges + noise, 0.0).astype(np.float32))
