"""Time as a thread has it, whatever else the machine is busy with."""

import os
import threading
import time
from pathlib import Path
from typing import BinaryIO, Optional

# proc(5): nanoseconds on a processor, nanoseconds of waiting for one, and how often it has had one.
STATISTICS = Path("/proc/thread-self/schedstat")
# Seconds for which what the system has told is new enough: asking costs as much as a small answer.
FRESH = 0.1


class _Thread(threading.local):
    """What Linux tells of this thread."""

    statistics: Optional[BinaryIO] = None
    is_opened: bool = False
    # When it was last asked, and what it told: seconds that the thread was kept waiting by then.
    asked_at: float = -FRESH
    waited: float = 0.0


_thread = _Thread()


def _reset() -> None:
    """A forked process has threads of its own, which have waited for nothing yet."""
    global _thread
    _thread = _Thread()


os.register_at_fork(after_in_child=_reset)


class Stopwatch:
    """Starts when it is made, and stands still while its thread could go on but others have all processors.

    Where the system does not tell of that, it never does.
    """

    def __init__(self) -> None:
        self._begun = time.perf_counter()
        if self._begun - _thread.asked_at > FRESH:
            _thread.asked_at, _thread.waited = self._begun, _seconds_kept_waiting()

    def seconds(self) -> float:
        """They may be less by what the thread was kept waiting in ``FRESH`` seconds before the start."""
        took = time.perf_counter() - self._begun
        return took if took <= FRESH else took - (_seconds_kept_waiting() - _thread.waited)


def _seconds_kept_waiting() -> float:
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
