"""Processes that keep processors busy."""

import signal
import subprocess
import sys
from contextlib import contextmanager
from typing import Iterator

from supervision.processes import ending_with_parent


@contextmanager
def busy_loops(count: int) -> Iterator[None]:
    """Keep ``count`` processors busy, at most until this process ends."""
    command = [sys.executable, "-c", "while True: pass"]
    end = ending_with_parent(signal.SIGTERM)
    loops = [subprocess.Popen(command, preexec_fn=end) for _ in range(count)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()
