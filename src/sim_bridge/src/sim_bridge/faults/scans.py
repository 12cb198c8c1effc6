"""Faults of a laser scanner."""

import math
from collections import deque
from dataclasses import replace
from typing import Deque, Optional

import numpy as np

from planar import Scan
from sim_bridge.faults.kind import FaultKind


class StoppedScan(FaultKind):
    """The laser publishes nothing."""

    survivable = False

    def scan(self, scan: Scan) -> Optional[Scan]:
        return None


class FrozenScan(FaultKind):
    """The laser repeats one scan with new stamps."""

    survivable = False

    _frozen: Optional[Scan] = None

    def scan(self, scan: Scan) -> Optional[Scan]:
        self._frozen = self._frozen or scan
        return replace(self._frozen, stamp=scan.stamp)


class MaskedScan(FaultKind):
    """An object stuck to the robot hides a sector to the front left."""

    strength = (1.0, 0.0, 6.3)
    unit = "rad"

    def scan(self, scan: Scan) -> Optional[Scan]:
        ranges = scan.ranges.copy()
        ranges[(scan.angles > 0.0) & (scan.angles < self._strength)] = np.nan
        return replace(scan, ranges=ranges)


class SparseScan(FaultKind):
    """Single beams are lost."""

    strength = (0.5, 0.0, 1.0)
    unit = "share"

    def scan(self, scan: Scan) -> Optional[Scan]:
        lost = self._rng.random(len(scan.ranges)) < self._strength
        return replace(scan, ranges=np.where(lost, np.nan, scan.ranges).astype(np.float32))


class NanScan(FaultKind):
    """All ranges are NaN."""

    survivable = False

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, ranges=np.full_like(scan.ranges, np.nan))


class InfiniteScan(FaultKind):
    """All ranges are infinite: no beam returns."""

    survivable = False

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, ranges=np.full_like(scan.ranges, np.inf))


class ZeroScan(FaultKind):
    """All ranges are 0, as with a covered lens."""

    survivable = False

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, ranges=np.full_like(scan.ranges, 0.0))


class BiasedScan(FaultKind):
    """All ranges are too long."""

    strength = (0.1, -1.0, 1.0)
    unit = "m"

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, ranges=scan.ranges + scan.ranges.dtype.type(self._strength))


class NoisyScan(FaultKind):
    """Ranges have additional Gaussian noise."""

    strength = (0.06, 0.0, 5.0)
    unit = "m"

    def scan(self, scan: Scan) -> Optional[Scan]:
        noise = self._rng.normal(0.0, self._strength, len(scan.ranges))
        return replace(scan, ranges=np.maximum(scan.ranges + noise, 0.0).astype(np.float32))


class LateScan(FaultKind):
    """Scans arrive late, with the stamps of their measurement."""

    strength = (0.5, 0.0, 10.0)
    unit = "s"

    def __init__(self, strength: float, rng: np.random.Generator):
        super().__init__(strength, rng)
        self._delayed: Deque[Scan] = deque()

    def scan(self, scan: Scan) -> Optional[Scan]:
        self._delayed.append(scan)
        is_due = self._delayed[0].stamp <= scan.stamp - self._strength
        return self._delayed.popleft() if is_due else None


class MisdatedScan(FaultKind):
    """Scans have shifted stamps; a positive strength shifts them into the future."""

    strength = (-0.3, -10.0, 10.0)
    unit = "s"

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, stamp=scan.stamp + self._strength)


class TurnedScan(FaultKind):
    """The laser's mounting has been rotated by an impact."""

    strength = (3.0, -180.0, 180.0)
    unit = "degrees"

    def scan(self, scan: Scan) -> Optional[Scan]:
        return replace(scan, angle_min=scan.angle_min - math.radians(self._strength))
