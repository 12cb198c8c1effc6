"""Threads of a node that take turns, one turn at each logical instant."""

import threading
from typing import Callable, Set


class LockstepThreads:
    """Lets registered threads run for one turn, and waits until all of them wait again."""

    def __init__(self):
        self._changed = threading.Condition()
        self._members: Set[int] = set()
        self._running: Set[int] = set()

    def register(self) -> None:
        """Register the calling thread; its first turn starts at once."""
        with self._changed:
            self._members.add(threading.get_ident())
            self._running.add(threading.get_ident())

    def unregister(self) -> None:
        """Unregister the calling thread."""
        with self._changed:
            self._members.discard(threading.get_ident())
            self._end_turn()

    def is_registered(self) -> bool:
        """Return whether the calling thread is registered."""
        return threading.get_ident() in self._members

    def wait_for_turn(self, is_off: Callable[[], bool]) -> None:
        """End the turn of the calling thread; return at its next turn or when ``is_off``."""
        with self._changed:
            self._end_turn()
            while threading.get_ident() not in self._running and not is_off():
                self._changed.wait(0.2)

    def run_turn(self, is_off: Callable[[], bool]) -> None:
        """Give every thread a turn; return when all have ended theirs or ``is_off``."""
        with self._changed:
            self._running = set(self._members)
            self._changed.notify_all()
        self.wait_until_idle(is_off)

    def wait_until_idle(self, is_off: Callable[[], bool]) -> None:
        """Wait until no thread has a turn or ``is_off``."""
        with self._changed:
            while self._running and not is_off():
                self._changed.wait(0.2)

    def notify(self) -> None:
        """Wake the waiting threads to check their conditions."""
        with self._changed:
            self._changed.notify_all()

    def _end_turn(self) -> None:
        self._running.discard(threading.get_ident())
        self._changed.notify_all()
