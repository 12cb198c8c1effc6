"""Detection of range readings that mean "no return", from how often they occur.

Where nothing is hit, some lasers report more than their ``range_max``, some a little less, and some another
constant. Interpreted as hits, such readings form a circle that moves with the robot.
"""

import math
from dataclasses import replace

import numpy as np

from planar.geometry.scan import Scan

# Bin size of the histogram [m], and range at which it starts [m]: nearer readings are seldom "no return".
_BIN, _NEAREST = 0.1, 15.0
# Farthest reading of any laser [m].
_FARTHEST = 1000.0
# Least count of the constant, its least share of all far readings, and bins by which it varies.
_MIN_COUNT, _MIN_SHARE, _BINS_BESIDE = 200, 0.1, 1


class NoReturnDetector:
    """Histogram of the far readings of scans made at different places.

    Attributes:
        distance: Range from which on readings mean "no return" [m]; infinite if there is no such constant.
    """

    def __init__(self) -> None:
        self._counts = np.zeros(0, dtype=np.int64)
        self.distance = math.inf

    def limited(self, scan: Scan) -> Scan:
        """Return a scan whose ``range_max`` is at most ``distance``."""
        return replace(scan, range_max=self.distance) if self.distance < scan.range_max else scan

    def add(self, ranges: np.ndarray) -> None:
        """Count the readings of one scan.

        Args:
            ranges: (N,) [m]; readings that are not finite are ignored.
        """
        far = ranges[np.isfinite(ranges) & (ranges > _NEAREST) & (ranges < _FARTHEST)]
        if len(far) == 0:
            return
        counts = np.bincount(np.floor(far / _BIN).astype(np.int64), minlength=len(self._counts))
        counts[: len(self._counts)] += self._counts
        self._counts = counts
        around = np.convolve(counts, np.ones(2 * _BINS_BESIDE + 1, dtype=np.int64), mode="same")
        most = int(np.argmax(around))
        if around[most] >= max(_MIN_COUNT, _MIN_SHARE * counts.sum()):
            self.distance = (most - _BINS_BESIDE) * _BIN
