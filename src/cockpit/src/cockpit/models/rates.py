"""Rates: how often messages arrive, and a timer that is due at a fixed rate."""

from collections import deque
from typing import Deque, Optional, Tuple

SECONDS = 5.0


class RateMeter:
    """Measures messages and bytes per second over a sliding window, from counters that only grow."""

    def __init__(self, seconds: float = SECONDS):
        self._seconds = seconds
        self._samples: Deque[Tuple[float, int, int]] = deque()

    def update(self, now: float, count: int, size: int) -> Tuple[float, float]:
        """Add a sample of the counters.

        Args:
            now: Steady-clock time [s].
            count: Messages received so far.
            size: Bytes received so far.

        Returns:
            Messages and bytes per second over the window; zeros for the first sample.
        """
        self._samples.append((now, count, size))
        while len(self._samples) > 2 and now - self._samples[1][0] >= self._seconds:
            self._samples.popleft()
        then, count_then, size_then = self._samples[0]
        span = now - then
        return ((count - count_then) / span, (size - size_then) / span) if span > 0.0 else (0.0, 0.0)


class PeriodicTimer:
    """Due at a fixed rate; missed periods are skipped."""

    def __init__(self) -> None:
        self._due: Optional[float] = None
        self._period = 0.0

    def start(self, now: float, period: float) -> None:
        """Start the timer, due at once.

        Args:
            now: Steady-clock time [s].
            period: Time between two periods [s].
        """
        self._due, self._period = now, period

    def stop(self) -> None:
        self._due = None

    def is_due(self, now: float) -> bool:
        """Return whether a period has begun since the last call that returned True."""
        if self._due is None or now < self._due:
            return False
        self._due = max(self._due + self._period, now)
        return True
