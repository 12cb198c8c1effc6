"""TITLE: a fault of sim_bridge."""

from dataclasses import replace
from typing import Optional

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class CLASS(FaultKind):
    """A random share of the beams of each scan has no echo, as with dust on the lens."""

    strength = (0.3, 0.0, 1.0)
    unit = "share of the beams"

    def scan(self, scan: Scan) -> Optional[Scan]:
        """See sim_bridge.faults.kind.FaultKind: the scan that is published instead."""
        ranges = scan.ranges.copy()
        ranges[self._rng.random(len(ranges)) < self._strength] = float("inf")
        return replace(scan, ranges=ranges)
