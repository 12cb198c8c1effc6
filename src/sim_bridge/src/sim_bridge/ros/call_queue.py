"""Queue of calls from other threads to the thread that owns the scene."""

import threading
from collections import deque
from concurrent.futures import CancelledError, Future
from typing import Callable, Collection, Deque, NamedTuple, TypeVar

import rospy

from planar_ros.lockstep.transport import caller

T = TypeVar("T")


class _Call(NamedTuple):
    """A call: what to run, what receives the result, the synchronised node that called, whether it acts."""

    function: Callable
    future: Future
    caller: str
    acts: bool


class CallQueue:
    """Calls that are run between two steps of the simulation; callers get the result or the error.

    Attributes:
        submitted: Number of calls so far.
        acted: Number of calls run so far that may have changed the scene.
    """

    def __init__(self):
        self._pending: Deque[_Call] = deque()
        self._changed = threading.Condition()
        self._is_closed = self._has_new = False
        self.submitted = self.acted = 0

    def call(self, function: Callable[[], T], acts: bool = True) -> T:
        """Run a function between two steps, wait for it, and return its result.

        Args:
            function: The function.
            acts: Whether it may change the scene.

        Raises:
            rospy.ServiceException: The simulation is shutting down.
            Exception: What the function raises.
        """
        try:
            return self.submit(function, acts).result()
        except CancelledError:
            raise rospy.ServiceException("the simulation is shutting down") from None

    def submit(self, function: Callable[[], T], acts: bool = True) -> "Future[T]":
        """Submit a function to be run between two steps, without waiting for it; arguments as ``call``."""
        future: Future[T] = Future()
        with self._changed:
            if self._is_closed:
                future.cancel()
            else:
                self._pending.append(_Call(function, future, caller(), acts))
            self._has_new = True
            self.submitted += 1
            self._changed.notify_all()
        return future

    def run_pending(self, awaited: Collection[str] = (), members: Collection[str] = ()) -> None:
        """Run pending calls, in the thread that owns the scene.

        Args:
            awaited: Synchronised nodes for whose answers simulated time is stopped: their calls are run.
            members: Synchronised nodes: their other calls stay pending, so that they run at the same
                simulated time in each run.
        """
        self._has_new = False
        if not self._pending:
            return
        with self._changed:
            due = [call for call in self._pending if call.caller in awaited or call.caller not in members]
            self._pending = deque(call for call in self._pending if call not in due)
        for call in due:
            self.acted += call.acts
            try:
                call.future.set_result(call.function())
            except Exception as error:
                call.future.set_exception(error)

    @property
    def has_pending(self) -> bool:
        """Whether calls have been submitted since ``run_pending``."""
        return self._has_new

    def wait(self, seconds: float) -> None:
        """Wait for new calls.

        Args:
            seconds: Longest time to wait [wall s].
        """
        with self._changed:
            if not (self._has_new or self._is_closed):
                self._changed.wait(seconds)

    def close(self) -> None:
        """Refuse pending and future calls."""
        with self._changed:
            self._is_closed = True
            while self._pending:
                self._pending.popleft().future.cancel()
            self._changed.notify_all()
