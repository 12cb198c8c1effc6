"""Whether the map itself is to be suspected: nothing has ever fitted it."""

import math

from amcl_lite.recovery.quality import FOUND_ABOVE, Quality

# Seconds of scans after which one of them should have fitted a map that is right.
PATIENCE = 8.0


class MisfitAlarm:
    """Says once that no scan has fitted the map since the first."""

    def __init__(self) -> None:
        self._is_settled = False
        self._first = math.nan

    def take(self, quality: Quality, stamp: float) -> bool:
        """Takes in the quality of a scan made at ``stamp``, seconds; returns whether to say so now."""
        if math.isnan(self._first) or stamp < self._first:
            self._first = stamp
        if quality.probability > FOUND_ABOVE:
            self._is_settled = True
        is_due = not self._is_settled and stamp - self._first > PATIENCE
        self._is_settled = self._is_settled or is_due
        return is_due
