"""Processes that keep processors busy."""

import subprocess
import sys
from contextlib import contextmanager
from typing import Iterator


@contextmanager
def busy_loops(count: int) -> Iterator[None]:
    """Keep ``count`` processors busy."""
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()
