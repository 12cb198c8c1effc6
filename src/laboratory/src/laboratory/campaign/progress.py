"""How far a campaign is, told in the terminal."""

import time
from typing import Callable

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

# Seconds between lines where there is no terminal.
PAUSE = 15.0


class Told:
    """Counts results: a bar in a terminal, else a line now and then. A context."""

    def __init__(self, total: int, clock: Callable[[], float] = time.monotonic):
        self._total, self._clock = total, clock
        self._played = self._won = 0
        self._began = self._spoke = clock()
        columns = (BarColumn(), MofNCompleteColumn(), TextColumn("{task.description}"), TimeRemainingColumn())
        self._bar = Progress(*columns)
        self._task = self._bar.add_task("", total=total)

    def __enter__(self) -> "Told":
        if self._bar.console.is_terminal:
            self._bar.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._bar.stop()

    def count(self, success: bool) -> None:
        """One more."""
        self._played, self._won = self._played + 1, self._won + success
        self._bar.update(self._task, advance=1, description=f"{self._won} succeeded")
        now = self._clock()
        if not self._bar.console.is_terminal and now - self._spoke >= PAUSE:
            self._spoke = now
            print(self.line(now), flush=True)

    def line(self, now: float) -> str:
        """How many, how fast, how long it will take."""
        pace = self._played / max(now - self._began, 1e-9)
        left = (self._total - self._played) / pace if self._played else float("inf")
        return (
            f"  {self._played} of {self._total} played, {self._won} succeeded, {60.0 * pace:.0f} a minute, "
            f"{left:.0f} s left"
        )
