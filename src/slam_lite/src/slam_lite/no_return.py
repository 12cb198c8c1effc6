"""What a laser says where it sees nothing, learned from what it says too often.

Some say more than their ``range_max``, some a little less, and some another constant. Taken for walls, such
readings are a circle that moves along with the robot.
"""

import math

import numpy as np

# Readings are counted in bins of this size, metres, from here on: nearer ones are seldom nothing.
_BIN, _NEAREST = 0.1, 15.0
# No laser sees farther, metres.
_FARTHEST = 1000.0
# A constant is said at least so often, and is this share of all far readings; it varies by some bins.
_OFTEN, _SHARE, _BINS_BESIDE = 200, 0.1, 1


class NoReturn:
    """Counts far readings of scans made at different places.

    ``distance``: readings from there on, metres, mean that nothing was seen; infinite if there are no such.
    """

    def __init__(self) -> None:
        self._counts = np.zeros(0, dtype=np.int64)
        self.distance = math.inf

    def add(self, ranges: np.ndarray) -> None:
        """Counts the readings (N,), metres, of one scan."""
        far = ranges[np.isfinite(ranges) & (ranges > _NEAREST) & (ranges < _FARTHEST)]
        if len(far) == 0:
            return
        seen = np.bincount(np.floor(far / _BIN).astype(np.int64), minlength=len(self._counts))
        seen[: len(self._counts)] += self._counts
        self._counts = seen
        around = np.convolve(seen, np.ones(2 * _BINS_BESIDE + 1, dtype=np.int64), mode="same")
        most = int(np.argmax(around))
        if around[most] >= max(_OFTEN, _SHARE * seen.sum()):
            self.distance = (most - _BINS_BESIDE) * _BIN
