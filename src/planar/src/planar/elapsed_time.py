"""Time that has passed, whatever becomes of the clock."""

from typing import Optional


class ElapsedTime:
    """Seconds since the first look at a clock; when it is set back, no time has passed.

    A moment to wait for, kept in the clock's own time, could lie ahead for ever then.
    """

    def __init__(self) -> None:
        self._seconds = 0.0
        self._latest: Optional[float] = None

    def update(self, now: float) -> float:
        """``now``: what the clock says, seconds."""
        if self._latest is not None:
            self._seconds += max(now - self._latest, 0.0)
        self._latest = now
        return self._seconds
