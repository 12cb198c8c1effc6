"""Progress of a campaign in the terminal."""

import time
from typing import Callable

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

# Seconds between progress lines if the output is not a terminal.
PRINT_PERIOD = 15.0


class CampaignProgress:
    """Context manager that shows a progress bar in a terminal and prints progress lines otherwise."""

    def __init__(self, total: int, clock: Callable[[], float] = time.monotonic):
        self._total, self._clock = total, clock
        self._completed = self._succeeded = 0
        self._start = self._last_print = clock()
        columns = (BarColumn(), MofNCompleteColumn(), TextColumn("{task.description}"), TimeRemainingColumn())
        self._bar = Progress(*columns)
        self._task = self._bar.add_task("", total=total)

    def __enter__(self) -> "CampaignProgress":
        if self._bar.console.is_terminal:
            self._bar.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._bar.stop()

    def count(self, success: bool) -> None:
        """Count a finished run."""
        self._completed, self._succeeded = self._completed + 1, self._succeeded + success
        self._bar.update(self._task, advance=1, description=f"{self._succeeded} succeeded")
        now = self._clock()
        if not self._bar.console.is_terminal and now - self._last_print >= PRINT_PERIOD:
            self._last_print = now
            print(self.line(now), flush=True)

    def line(self, now: float) -> str:
        """Return the progress line: runs completed, rate and estimated remaining time."""
        rate = self._completed / max(now - self._start, 1e-9)
        remaining = (self._total - self._completed) / rate if self._completed else float("inf")
        return (
            f"  {self._completed} of {self._total} runs completed, {self._succeeded} succeeded, "
            f"{60.0 * rate:.0f} runs/min, {remaining:.0f} s remaining"
        )
