"""Real time for as long as a project's programs start."""

from typing import Callable

REAL_TIME = 1.0
# Wall time after the last start [s]: the next may follow, and the list of programs is not always fresh.
PAUSE_SECONDS = 0.5
# Wall time after the last window from which on starting no longer counts [s]: a program is started for ever.
NO_MORE_WINDOWS_SECONDS = 60.0


class RealTimeLimit:
    """Decides when simulated time may pass faster than real time.

    A program takes wall time to start: with a faster simulation it would come late in simulated time, when
    the robot is already on its way.

    Args:
        speed: Multiple of real time without the limit; 0 for no limit.
        set_speed: Called with each new speed.
    """

    def __init__(self, speed: float, set_speed: Callable[[float], None]):
        self._free = speed
        self._limited = speed if 0.0 < speed < REAL_TIME else REAL_TIME
        self._set_speed = set_speed
        self._latest_start = self._latest_window = 0.0
        self._is_limited = False

    def start(self, now: float) -> None:
        """Limit the speed from the start of the script on, at a wall time [s]."""
        self._latest_start = self._latest_window = now
        self._apply(True)

    def update(self, now: float, is_starting: bool, has_new_window: bool) -> None:
        """Adapt the speed to whether programs start at a wall time [s]."""
        self._latest_start = now if is_starting else self._latest_start
        self._latest_window = now if has_new_window else self._latest_window
        starts = now - self._latest_start < PAUSE_SECONDS
        self._apply(starts and now - self._latest_window < NO_MORE_WINDOWS_SECONDS)

    def _apply(self, is_limited: bool) -> None:
        if is_limited != self._is_limited and self._limited != self._free:
            self._set_speed(self._limited if is_limited else self._free)
        self._is_limited = is_limited
