"""Bounded storage for a time series."""

from array import array

import numpy as np

SAMPLES_PER_SECOND = 10.0
# Samples of sixteen minutes.
MAX_SAMPLES = 9_600


class Samples:
    """Rows of numbers, the first being the stamp [s], at ten samples per simulated second.

    When there are more than ``most``, every other sample is dropped and the rate halved.

    Args:
        columns: Numbers in a row.
        most: Maximum number of rows.
    """

    def __init__(self, columns: int, most: int = MAX_SAMPLES):
        self._columns, self._most = columns, most
        self._per_second = SAMPLES_PER_SECOND
        self._numbers = array("d")

    def is_due(self, stamp: float) -> bool:
        """Whether a sample with this stamp is to be stored: the first in each sampling interval."""
        return not self._numbers or self._slot(stamp) != self._slot(self._numbers[-self._columns])

    def add(self, *row: float) -> None:
        """Append a row."""
        self._numbers.extend(row)
        if len(self._numbers) > self._most * self._columns:
            self._thin()

    def rows(self) -> np.ndarray:
        """Return all stored rows, (N, columns)."""
        return np.array(self._numbers).reshape(-1, self._columns)

    def _slot(self, stamp: float) -> int:
        return int(stamp * self._per_second + 1e-6)

    def _thin(self) -> None:
        self._per_second /= 2.0
        rows = self.rows()
        slots = np.array([self._slot(stamp) for stamp in rows[:, 0]])
        is_kept = np.concatenate([[True], np.diff(slots) != 0])
        self._numbers = array("d", rows[is_kept].ravel())
