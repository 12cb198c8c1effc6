"""Simulated time stands still while a project's programs start."""

import math
import threading
from typing import Callable, List

REAL_TIME = 1.0
# Wall time after the last start [s]: what a program does first, and the next one, may follow.
PAUSE_SECONDS = 0.3
# Wall time after the last window from which on starting no longer counts [s]: a program is started for ever.
NO_MORE_WINDOWS_SECONDS = 60.0


class TimeHold:
    """Decides up to which simulated time the simulation may go.

    A program takes wall time to start, more on a busy machine. Time stands still meanwhile, and stops where a
    script's sleep ends, so that the next program starts at the same simulated time in each run.

    Args:
        speed: Speed of the simulation as a multiple of real time, 0 for no limit; up to 1 it is not held.
        simulated_time: Returns the simulated time [s].
        set_hold: Called with each new time to hold the simulation at [simulated s]; infinite for none.
    """

    def __init__(self, speed: float, simulated_time: Callable[[], float], set_hold: Callable[[float], None]):
        self._is_free = 0.0 < speed <= REAL_TIME
        self._simulated_time, self._set_hold = simulated_time, set_hold
        self._lock = threading.Lock()
        self._ends: List[float] = []
        self._latest_start = self._latest_window = 0.0
        self._is_starting, self._held_since = False, 0.0
        self._held_at = math.inf

    @property
    def is_starting(self) -> bool:
        """Whether time stands still as programs start."""
        return self._is_starting and not self._is_free

    def start(self, now: float) -> None:
        """Hold the simulation from the start of the script on, at a wall time [s]."""
        with self._lock:
            self._latest_start = self._latest_window = now
            self._apply(True)

    def update(self, now: float, is_starting: bool, has_new_window: bool) -> None:
        """Adapt the hold to whether programs start at a wall time [s]."""
        with self._lock:
            self._latest_start = now if is_starting else self._latest_start
            self._latest_window = now if has_new_window else self._latest_window
            starts = now - self._latest_start < PAUSE_SECONDS
            self._apply(starts and now - self._latest_window < NO_MORE_WINDOWS_SECONDS)

    def begin_sleep(self, end: float) -> None:
        """Stop the simulation at the end of a sleep [simulated s]."""
        with self._lock:
            self._ends.append(end)
            self._apply(self._is_starting)

    def end_sleep(self, end: float, now: float) -> None:
        """Hold the simulation, as a sleep ends at a wall time [s], for what the script starts then."""
        with self._lock:
            self._ends.remove(end)
        self.update(now, True, False)

    def _apply(self, is_starting: bool) -> None:
        if is_starting and not self._is_starting:
            self._held_since = self._simulated_time()
        self._is_starting = is_starting
        held_at = self._held_since if is_starting else min(self._ends, default=math.inf)
        if held_at != self._held_at and not self._is_free:
            self._set_hold(held_at)
        self._held_at = held_at
