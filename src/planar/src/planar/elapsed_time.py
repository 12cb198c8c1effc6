"""Elapsed time of a clock that may jump back."""

from typing import Optional


class ElapsedTime:
    """Seconds since the first reading of a clock; a jump back counts as no time.

    Deadlines stored as absolute times would lie in the future indefinitely after such a jump.
    """

    def __init__(self) -> None:
        self._seconds = 0.0
        self._latest: Optional[float] = None

    def update(self, now: float) -> float:
        """Return the elapsed time.

        Args:
            now: Reading of the clock [s].

        Returns:
            Seconds since the first reading, without jumps back.
        """
        if self._latest is not None:
            self._seconds += max(now - self._latest, 0.0)
        self._latest = now
        return self._seconds
