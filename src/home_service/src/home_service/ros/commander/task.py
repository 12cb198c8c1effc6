"""A command in progress: it ends by itself, by being cancelled, or because time is up or stands still."""

import threading
import time
from typing import Callable, Optional

import rospy

from home_service.ros.commander.outcomes import Feedback, Outcome, Result

POLL_SECONDS = 0.02
# Wall-clock seconds after which what stands still is taken to be gone.
PATIENCE_SECONDS = 10.0


class CommanderTask:
    """A command in progress. ``timeout``: seconds of ROS time."""

    def __init__(self, timeout: float):
        self._timeout = timeout
        self._start: Optional[float] = None
        self._is_cancelled = threading.Event()

    def run(self) -> Outcome:
        """Does it; returns how it ended."""
        raise NotImplementedError

    def feedback(self) -> Feedback:
        raise NotImplementedError

    def cancel(self) -> None:
        self._is_cancelled.set()

    @property
    def _seconds(self) -> float:
        return 0.0 if self._start is None else rospy.get_time() - self._start

    def _wait(self, step: Callable[[], Optional[Outcome]]) -> Outcome:
        """Calls ``step`` until it has an outcome, or another reason ends the command."""
        self._start = latest = rospy.get_time()
        ticked = time.monotonic()
        while True:
            outcome = step()
            if outcome is not None:
                return outcome
            now, wall = rospy.get_time(), time.monotonic()
            if now != latest:
                latest, ticked = now, wall
            if self._is_cancelled.is_set() or rospy.is_shutdown():
                return Outcome(Result.CANCELLED, "cancelled")
            if now - self._start > self._timeout:
                return Outcome(Result.TIMED_OUT, f"not done within {self._timeout:g} s")
            if wall - ticked > PATIENCE_SECONDS:
                return Outcome(Result.FAILED, f"the clock has stood still for {PATIENCE_SECONDS:g} s")
            time.sleep(POLL_SECONDS)
