"""The processes below this one: none may hide, and none may be left."""

import contextlib
import ctypes
import os
import signal
import time
from typing import Callable, List

import psutil

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
# Within which a process ends when it is asked to.
SIGTERM_SECONDS = 2.0


def start_of_this_process() -> float:
    """When this process began, in seconds of the wall clock as ``time.time`` tells them."""
    return psutil.Process().create_time()


def adopt_orphans() -> None:
    """Makes this process the parent of every descendant whose own parent dies, so that none can hide."""
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def ending_with_parent(number: int = signal.SIGINT) -> Callable[[], None]:
    """For a child between fork and exec: it is sent the signal when this process ends, be it by SIGKILL.

    Linux takes the end of the thread that forks for that of the process: it is to be the main one.
    """
    parent = os.getpid()

    def follow() -> None:
        # What a handler of the parent's were to note here, the program to come would never hear.
        signal.signal(number, signal.SIG_DFL)
        end_when_orphaned(parent, number)

    return follow


def end_when_orphaned(parent: int, number: int) -> None:
    """This process is sent the signal when ``parent`` ends, and at once if it has ended already."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, number, 0, 0, 0)
    if os.getppid() != parent:
        os.kill(os.getpid(), number)


def end_descendants(patience: float = SIGTERM_SECONDS) -> None:
    """Terminates and, after ``patience`` seconds, kills every descendant of this process, however deep."""
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
    """A zombie is not, nor one that has ended since it was listed."""
    with contextlib.suppress(psutil.NoSuchProcess):
        return process.status() != psutil.STATUS_ZOMBIE
    return False


def _signal(process: psutil.Process, number: int) -> None:
    with contextlib.suppress(psutil.NoSuchProcess):
        process.send_signal(number)
