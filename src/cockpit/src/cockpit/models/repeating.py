"""Something done again and again."""

from typing import Optional


class Repeating:
    """Due at a fixed rate; turns that were missed are not made up for."""

    def __init__(self) -> None:
        self._due: Optional[float] = None
        self._period = 0.0

    def start(self, now: float, period: float) -> None:
        """Due at once; ``now``, ``period``: seconds."""
        self._due, self._period = now, period

    def stop(self) -> None:
        self._due = None

    def is_due(self, now: float) -> bool:
        """Whether it is to be done now; asked again it is not, until the next turn."""
        if self._due is None or now < self._due:
            return False
        self._due = max(self._due + self._period, now)
        return True
