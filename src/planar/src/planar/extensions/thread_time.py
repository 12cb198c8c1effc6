"""Stopwatch that excludes the time in which a thread waits for a processor."""

import os
import threading
import time
from pathlib import Path
from typing import BinaryIO, Optional

# proc(5): nanoseconds on a processor, nanoseconds of waiting for one, and number of time slices.
STATISTICS = Path("/proc/thread-self/schedstat")
# Seconds for which the statistics are reused: reading them costs as much as a short call.
MAX_AGE = 0.1


class _Thread(threading.local):
    """Scheduler statistics of the current thread.

    Attributes:
        statistics: Open file of the statistics; None if there is none.
        is_opened: Whether opening it has been tried.
        read_at: When they were last read.
        waited: Seconds the thread had waited for a processor by then.
    """

    statistics: Optional[BinaryIO] = None
    is_opened: bool = False
    read_at: float = -MAX_AGE
    waited: float = 0.0


_thread = _Thread()


def _reset() -> None:
    """Discard the statistics of the parent in a forked process, whose threads are others."""
    global _thread
    _thread = _Thread()


os.register_at_fork(after_in_child=_reset)


class Stopwatch:
    """Measures wall time from its construction, less the time its thread waits for a processor.

    Without ``/proc/thread-self/schedstat`` it measures wall time.
    """

    def __init__(self) -> None:
        self._start = time.perf_counter()
        if self._start - _thread.read_at > MAX_AGE:
            _thread.read_at, _thread.waited = self._start, _seconds_waited()

    def seconds(self) -> float:
        """Elapsed time [s]; too short by at most the waiting time in ``MAX_AGE`` seconds before the start."""
        elapsed = time.perf_counter() - self._start
        return elapsed if elapsed <= MAX_AGE else elapsed - (_seconds_waited() - _thread.waited)


def _seconds_waited() -> float:
    if not _thread.is_opened:
        _thread.statistics, _thread.is_opened = _opened(), True
    if _thread.statistics is None:
        return 0.0
    return int(os.pread(_thread.statistics.fileno(), 80, 0).split()[1]) * 1e-9


def _opened() -> Optional[BinaryIO]:
    try:
        return STATISTICS.open("rb", buffering=0)
    except OSError:
        return None
