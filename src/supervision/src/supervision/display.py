"""What a person sees in the terminal while a run goes on."""

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
    """A status line that is rewritten in a terminal, and repeated now and then in a log."""

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
        """Shows no status any more: the terminal belongs to somebody else."""
        self.__exit__()
        self._latest_plain = math.inf

    def print(self, line: str) -> None:
        """Prints a line that stays."""
        with self._lock:
            self._console.print(escape(line))

    def show(self, status: str) -> None:
        """Shows how things stand right now."""
        with self._lock:
            if self._status is not None:
                self._status.update(escape(status))
            elif time.monotonic() - self._latest_plain >= PLAIN_SECONDS:
                self._latest_plain = time.monotonic()
                self._console.print(escape(status))


def print_error(text: str) -> None:
    """One line on stderr."""
    print(f"error: {text}", file=sys.stderr, flush=True)
