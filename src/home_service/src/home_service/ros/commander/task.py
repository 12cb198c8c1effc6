"""A command in progress; it ends when it is done, cancelled or late, or when ROS time stops."""

import threading
import time
from typing import Callable, Optional

import rospy

from home_service.ros.commander.outcomes import Feedback, Outcome, Result

POLL_SECONDS = 0.02
# Wall-clock time without progress after which a clock, a server or odometry counts as lost [s].
PATIENCE_SECONDS = 10.0


class CommanderTask:
    """A command in progress.

    Args:
        timeout: Time limit in ROS time [s].
    """

    def __init__(self, timeout: float):
        self._timeout = timeout
        self._start: Optional[float] = None
        self._is_cancelled = threading.Event()

    def run(self) -> Outcome:
        """Execute the command and return its outcome."""
        raise NotImplementedError

    def feedback(self) -> Feedback:
        raise NotImplementedError

    def cancel(self) -> None:
        self._is_cancelled.set()

    @property
    def _seconds(self) -> float:
        return 0.0 if self._start is None else rospy.get_time() - self._start

    def _wait(self, step: Callable[[], Optional[Outcome]]) -> Outcome:
        """Call ``step`` until it returns an outcome, or the command ends for another reason."""
        self._start = latest = rospy.get_time()
        advanced_at = time.monotonic()
        while True:
            outcome = step()
            if outcome is not None:
                return outcome
            now, wall = rospy.get_time(), time.monotonic()
            if now != latest:
                latest, advanced_at = now, wall
            if self._is_cancelled.is_set() or rospy.is_shutdown():
                return Outcome(Result.CANCELLED, "cancelled")
            if now - self._start > self._timeout:
                return Outcome(Result.TIMED_OUT, f"not done within {self._timeout:g} s")
            if wall - advanced_at > PATIENCE_SECONDS:
                return Outcome(Result.FAILED, f"the clock has stood still for {PATIENCE_SECONDS:g} s")
            time.sleep(POLL_SECONDS)
