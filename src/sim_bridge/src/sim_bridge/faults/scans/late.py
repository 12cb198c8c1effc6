"""The kind ``scan_late``."""

from collections import deque
from typing import Deque, Optional

import numpy as np

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class LateScan(FaultKind):
    """Scans come late, with the stamps of their measurement."""

    strength = (0.5, 0.0, 10.0)
    unit = "s"

    def __init__(self, strength: float, rng: np.random.Generator):
        super().__init__(strength, rng)
        self._waiting: Deque[Scan] = deque()

    def scan(self, scan: Scan) -> Optional[Scan]:
        self._waiting.append(scan)
        is_due = self._waiting[0].stamp <= scan.stamp - self._strength
        return self._waiting.popleft() if is_due else None
