"""How often something comes, over the last few seconds."""

from collections import deque
from typing import Deque, Tuple

SECONDS = 5.0


class Rate:
    """Messages and bytes a second, from counters that only grow."""

    def __init__(self, seconds: float = SECONDS):
        self._seconds = seconds
        self._seen: Deque[Tuple[float, int, int]] = deque()

    def update(self, now: float, count: int, size: int) -> Tuple[float, float]:
        """``now``: seconds by a steady clock. Returns messages and bytes a second, 0 at first."""
        self._seen.append((now, count, size))
        while len(self._seen) > 2 and now - self._seen[1][0] >= self._seconds:
            self._seen.popleft()
        then, count_then, size_then = self._seen[0]
        span = now - then
        return ((count - count_then) / span, (size - size_then) / span) if span > 0.0 else (0.0, 0.0)
