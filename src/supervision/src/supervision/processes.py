"""Descendants of this process: find and end all of them."""

import contextlib
import ctypes
import os
import signal
import time
from typing import Callable, List

import psutil

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
# Time for a process to end after SIGTERM [s].
SIGTERM_SECONDS = 2.0


def start_of_this_process() -> float:
    """Return when this process was started, in seconds of ``time.time``."""
    return psutil.Process().create_time()


def adopt_orphans() -> None:
    """Become the parent of every descendant whose parent dies, so that none is lost."""
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def ending_with_parent(number: int = signal.SIGINT) -> Callable[[], None]:
    """Return a function that makes a child, between fork and exec, receive a signal when this process ends.

    Linux reports the end of the forking thread, so call it from the main thread.
    """
    parent = os.getpid()

    def follow() -> None:
        # A signal taken by the parent's handler would be lost for the program to come.
        signal.signal(number, signal.SIG_DFL)
        end_when_orphaned(parent, number)

    return follow


def end_when_orphaned(parent: int, number: int) -> None:
    """Send this process a signal when ``parent`` ends, or at once if it has ended."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, number, 0, 0, 0)
    if os.getppid() != parent:
        os.kill(os.getpid(), number)


def end_descendants(patience: float = SIGTERM_SECONDS) -> None:
    """Terminate all descendants of this process and kill them after ``patience`` seconds."""
    deadline = time.monotonic() + patience
    descendants = _living_descendants()
    for process in descendants:
        _signal(process, signal.SIGTERM)
    while descendants:
        psutil.wait_procs(descendants, timeout=0.1)
        descendants = _living_descendants()
        if time.monotonic() > deadline:
            for process in descendants:
                _signal(process, signal.SIGKILL)


def _living_descendants() -> List[psutil.Process]:
    return [process for process in psutil.Process().children(recursive=True) if _is_alive(process)]


def _is_alive(process: psutil.Process) -> bool:
    """Whether a process is neither a zombie nor gone."""
    with contextlib.suppress(psutil.NoSuchProcess):
        return process.status() != psutil.STATUS_ZOMBIE
    return False


def _signal(process: psutil.Process, number: int) -> None:
    with contextlib.suppress(psutil.NoSuchProcess):
        process.send_signal(number)
