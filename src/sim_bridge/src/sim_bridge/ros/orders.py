"""What other threads ask of the one thread that may touch the scene."""

import threading
from collections import deque
from concurrent.futures import CancelledError, Future
from typing import Callable, Collection, Deque, Tuple, TypeVar

import rospy

from planar_ros.step.calls import caller

T = TypeVar("T")


class Orders:
    """A queue of calls; those who ask wait for the result, or get the error."""

    def __init__(self):
        self._waiting: Deque[Tuple[Callable, Future, str]] = deque()
        self._changed = threading.Condition()
        self._is_closed = self._has_news = False

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
                self._waiting.append((do, future, caller()))
            self._has_news = True
            self._changed.notify_all()
        return future

    def carry_out(self, awaited: Collection[str] = (), members: Collection[str] = ()) -> None:
        """Calls what is waiting; in the thread that owns the scene.

        What ``members``, nodes in step, ask for waits until time stands still because they are ``awaited``.
        """
        self._has_news = False
        if not self._waiting:
            return
        with self._changed:
            due = [order for order in self._waiting if order[2] in awaited or order[2] not in members]
            self._waiting = deque(order for order in self._waiting if order not in due)
        for do, future, _ in due:
            try:
                future.set_result(do())
            except Exception as error:
                future.set_exception(error)

    @property
    def are_waiting(self) -> bool:
        """Whether any have come since they were last carried out."""
        return self._has_news

    def wait(self, seconds: float) -> None:
        """Waits for orders, at most so long."""
        with self._changed:
            if not (self._has_news or self._is_closed):
                self._changed.wait(seconds)

    def close(self) -> None:
        """Takes no more orders and refuses those that wait."""
        with self._changed:
            self._is_closed = True
            while self._waiting:
                self._waiting.popleft()[1].cancel()
            self._changed.notify_all()
