"""What other threads ask of the one thread that may touch the scene."""

import threading
from collections import deque
from concurrent.futures import CancelledError, Future
from typing import Callable, Deque, Tuple, TypeVar

import rospy

T = TypeVar("T")


class Orders:
    """A queue of calls; those who ask wait for the result, or get the error."""

    def __init__(self):
        self._waiting: Deque[Tuple[Callable, Future]] = deque()
        self._changed = threading.Condition()
        self._is_closed = False

    def ask(self, do: Callable[[], T]) -> T:
        """Has ``do`` called between two steps; returns what it returns, raises what it raises."""
        try:
            return self.leave(do).result()
        except CancelledError:
            raise rospy.ServiceException("the simulation is shutting down") from None

    def leave(self, do: Callable[[], T]) -> "Future[T]":
        """Has ``do`` called between two steps, without waiting for it."""
        future: Future[T] = Future()
        with self._changed:
            if self._is_closed:
                future.cancel()
            else:
                self._waiting.append((do, future))
            self._changed.notify_all()
        return future

    def carry_out(self) -> None:
        """Calls what is waiting; in the thread that owns the scene."""
        while self._waiting:
            do, future = self._waiting.popleft()
            try:
                future.set_result(do())
            except Exception as error:
                future.set_exception(error)

    def wait(self, seconds: float) -> None:
        """Waits for orders, at most so long."""
        with self._changed:
            if not (self._waiting or self._is_closed):
                self._changed.wait(seconds)

    def close(self) -> None:
        """Takes no more orders and refuses those that wait."""
        with self._changed:
            self._is_closed = True
            while self._waiting:
                self._waiting.popleft()[1].cancel()
            self._changed.notify_all()
