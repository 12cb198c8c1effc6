"""Sleeping of a project's scripts by simulated time.

Authors separate windows by ``sleep``, for a simulation that runs in real time. Here it may run faster, or
slower on a busy machine: the next window opens at the same simulated time as with theirs.
"""

import contextlib
import math
import os
import secrets
import socketserver
import threading
import time
from typing import Callable, Optional

from run_project.time_hold import TimeHold

POLL_SECONDS = 0.01
# Wall time without a step of the clock after which no simulation runs [s].
STANDSTILL_SECONDS = 1.0
# Reports in succession without a program that starts, from which on all that were started have come up: the
# first may be older than the sleep.
QUIET_REPORTS = 2
# Wall time for which programs that start can stop the time of one sleep [s].
STARTING_SECONDS = 30.0
MAX_REQUEST_BYTES = 64
# Less than a step of the simulation, more than errors of rounding [s].
ROUNDING = 1e-3


class ScriptTime:
    """Time that passes for a script: simulated while a simulation runs, else wall time.

    What has passed before simulated time begins does not count afterwards, and none passes while programs
    start: both depend on the machine.

    Args:
        wall: Wall time at the start [s].
        simulated: Simulated time at the start [s].
    """

    def __init__(self, wall: float, simulated: float):
        self._wall, self._simulated = wall, simulated
        self._latest_step = -math.inf
        self._has_begun = simulated > 0.0
        self._starting = self._elapsed = 0.0

    def update(self, wall: float, simulated: float, is_starting: bool = False) -> float:
        """Return the time since the start [s].

        Args:
            wall: Wall time [s].
            simulated: Simulated time [s]; 0 before it begins.
            is_starting: Whether programs start.
        """
        passed = wall - self._wall
        if simulated > self._simulated:
            self._elapsed = self._elapsed + simulated - self._simulated if self._has_begun else simulated
            self._has_begun, self._latest_step = True, wall
        elif is_starting and self._starting < STARTING_SECONDS:
            self._starting += passed
        elif wall - self._latest_step > STANDSTILL_SECONDS:
            self._elapsed += passed
        self._wall, self._simulated = wall, simulated
        return self._elapsed


class ScriptSleeps:
    """Serves the stand-in for ``sleep``: context in which scripts sleep by simulated time.

    While no simulated time can begin, as no simulator has been started or it waits for nodes that have not,
    they sleep until the programs started so far have come up, and not longer than they want by wall time in
    which none starts.

    Args:
        simulated_time: Returns the simulated time [s].
        hold: Stops the simulation at the end of each sleep.

    Attributes:
        address: Name of the socket, in Linux's abstract namespace.
    """

    def __init__(self, simulated_time: Callable[[], float], hold: TimeHold):
        self._simulated_time, self._hold = simulated_time, hold
        self._is_over = threading.Event()
        self._quiet_reports = 0
        self._is_starting = False
        self._server: Optional[socketserver.ThreadingUnixStreamServer] = None
        self.address = f"run_project_{os.getpid()}_{secrets.token_hex(8)}"

    def __enter__(self) -> "ScriptSleeps":
        sleeps = self

        class Handler(socketserver.StreamRequestHandler):
            def handle(self) -> None:
                with contextlib.suppress(ValueError, OSError):
                    sleeps.sleep(float(self.rfile.readline(MAX_REQUEST_BYTES)))

        self._server = socketserver.ThreadingUnixStreamServer(f"\0{self.address}", Handler)
        self._server.daemon_threads = True
        threading.Thread(target=self._server.serve_forever, args=(POLL_SECONDS,), daemon=True).start()
        return self

    def __exit__(self, *_) -> None:
        self._is_over.set()
        if self._server is not None:
            self._server.shutdown()
            self._server.server_close()

    def update(self, is_starting: bool, is_time_due: bool) -> None:
        """Report whether programs are starting, and whether a simulator runs whose time begins soon."""
        self._is_starting = is_starting
        self._quiet_reports = 0 if is_starting or is_time_due else self._quiet_reports + 1

    def sleep(self, seconds: float) -> None:
        """Wait for a time [s], or until the context is left."""
        self._quiet_reports = 0
        begin = self._simulated_time()
        elapsed, end, wanted = ScriptTime(time.monotonic(), begin), begin + seconds, seconds - ROUNDING
        self._hold.begin_sleep(end)
        while elapsed.update(time.monotonic(), self._simulated_time(), self._is_starting) < wanted:
            if self._simulated_time() == 0.0 and self._quiet_reports >= QUIET_REPORTS:
                break
            if self._is_over.wait(POLL_SECONDS):
                return
        self._hold.end_sleep(end, time.monotonic())
