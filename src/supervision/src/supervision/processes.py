"""The processes below this one: none may hide, and none may be left."""

import contextlib
import ctypes
import random
import signal
import socket
import time
from typing import List

import psutil

from supervision.errors import LaunchError

FIRST_PORT, FIRST_OUTGOING_PORT = 20000, 32768
PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36


def start_of_this_process() -> float:
    """When this process began, in seconds of the wall clock as ``time.time`` tells them."""
    return psutil.Process().create_time()


def free_port() -> int:
    """A TCP port on the loopback interface that nobody listens on right now.

    It lies below those that the system hands out for outgoing connections: one of these, of another graph for
    example, might take it before a master listens there.
    """
    ports = range(FIRST_PORT, FIRST_OUTGOING_PORT)
    for port in random.Random().sample(ports, len(ports)):
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return port
    raise LaunchError(f"every port from {ports[0]} to {ports[-1]} is in use")


def adopt_orphans() -> None:
    """Makes this process the parent of every descendant whose own parent dies, so that none can hide."""
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def end_with_parent() -> None:
    """For a child between fork and exec: it is sent SIGINT when its parent ends, be it by SIGKILL."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGINT, 0, 0, 0)


def end_descendants(patience: float) -> None:
    """Terminates and, after ``patience`` seconds, kills every descendant of this process, however deep."""
    deadline = time.monotonic() + patience
    descendants: List[psutil.Process] = psutil.Process().children(recursive=True)
    for process in descendants:
        _signal(process, signal.SIGTERM)
    while descendants:
        psutil.wait_procs(descendants, timeout=0.1)
        descendants = [
            process
            for process in psutil.Process().children(recursive=True)
            if process.status() != psutil.STATUS_ZOMBIE
        ]
        if time.monotonic() > deadline:
            for process in descendants:
                _signal(process, signal.SIGKILL)


def _signal(process: psutil.Process, number: int) -> None:
    with contextlib.suppress(psutil.NoSuchProcess):
        process.send_signal(number)
