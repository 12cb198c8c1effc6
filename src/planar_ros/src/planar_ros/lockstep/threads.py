"""Threads of a node that work in turns, one a moment."""

import threading
from typing import Callable, Set


class LockstepThreads:
    """Lets every thread that takes turns go on, and waits until all of them pause again."""

    def __init__(self):
        self._changed = threading.Condition()
        self._players: Set[int] = set()
        self._playing: Set[int] = set()

    def register(self) -> None:
        """From now on the calling thread takes turns; its first one is on."""
        with self._changed:
            self._players.add(threading.get_ident())
            self._playing.add(threading.get_ident())

    def unregister(self) -> None:
        """The calling thread takes no more turns."""
        with self._changed:
            self._players.discard(threading.get_ident())
            self._end_turn()

    def is_registered(self) -> bool:
        """Whether the calling thread takes turns."""
        return threading.get_ident() in self._players

    def wait_for_turn(self, is_off: Callable[[], bool]) -> None:
        """Ends the calling thread's turn; returns at its next one, or when ``is_off``."""
        with self._changed:
            self._end_turn()
            while threading.get_ident() not in self._playing and not is_off():
                self._changed.wait(0.2)

    def run_turn(self, is_off: Callable[[], bool]) -> None:
        """Gives every thread a turn; returns when all have ended theirs, or ``is_off``."""
        with self._changed:
            self._playing = set(self._players)
            self._changed.notify_all()
        self.wait_until_idle(is_off)

    def wait_until_idle(self, is_off: Callable[[], bool]) -> None:
        """Waits until no thread has a turn, or ``is_off``."""
        with self._changed:
            while self._playing and not is_off():
                self._changed.wait(0.2)

    def notify(self) -> None:
        """Something has changed for those who wait."""
        with self._changed:
            self._changed.notify_all()

    def _end_turn(self) -> None:
        self._playing.discard(threading.get_ident())
        self._changed.notify_all()
