"""Terminal output of a run."""

import math
import sys
import threading
import time
from typing import Optional

from rich.console import Console
from rich.markup import escape
from rich.status import Status

PLAIN_SECONDS = 5.0


class Display:
    """A status line that is updated in a terminal, and printed from time to time in a log."""

    def __init__(self):
        self._console = Console(highlight=False, soft_wrap=True)
        self._status: Optional[Status] = None
        self._lock = threading.Lock()
        self._latest_plain = -PLAIN_SECONDS

    def __enter__(self):
        if self._console.is_terminal:
            self._status = self._console.status("starting")
            self._status.start()
        return self

    def __exit__(self, *_):
        if self._status is not None:
            self._status.stop()
            self._status = None

    def release_terminal(self) -> None:
        """Show no status any more, because another program uses the terminal."""
        self.__exit__()
        self._latest_plain = math.inf

    def print(self, line: str) -> None:
        """Print a line."""
        with self._lock:
            self._console.print(escape(line))

    def show(self, status: str) -> None:
        """Show the current status."""
        with self._lock:
            if self._status is not None:
                self._status.update(escape(status))
            elif time.monotonic() - self._latest_plain >= PLAIN_SECONDS:
                self._latest_plain = time.monotonic()
                self._console.print(escape(status))


def print_error(text: str) -> None:
    """Print an error in one line on stderr."""
    print(f"error: {text}", file=sys.stderr, flush=True)
