"""Background calls: a tool calls other nodes and programs without blocking."""

import threading
from typing import Any, Callable, List, Optional, Tuple

from cockpit.errors import CockpitError


class BackgroundCall:
    """Runs one call at a time in a daemon thread."""

    def __init__(self) -> None:
        self._done: List[Tuple[Optional[Exception], Any]] = []
        self._thread: Optional[threading.Thread] = None

    @property
    def is_busy(self) -> bool:
        return self._thread is not None and self._thread.is_alive()

    def start(self, do: Callable[[], Any]) -> None:
        """Start a call.

        Raises:
            CockpitError: The previous call is still running.
        """
        if self.is_busy:
            raise CockpitError("the previous request is still running; wait for its answer")
        self.restart(do)

    def restart(self, do: Callable[[], Any]) -> None:
        """Start a call and discard the result of the previous one."""
        done: List[Tuple[Optional[Exception], Any]] = []
        self._done = done
        self._thread = threading.Thread(target=_work, args=(do, done), daemon=True)
        self._thread.start()

    def results(self) -> List[Any]:
        """Return the new result, if any, as a list.

        Raises:
            Exception: The exception of the call.
        """
        if not self._done:
            return []
        error, result = self._done.pop()
        if error is not None:
            raise error
        return [result]


def _work(do: Callable[[], Any], done: List[Tuple[Optional[Exception], Any]]) -> None:
    try:
        result = do()
    except Exception as error:  # raised again by results()
        done.append((error, None))
    else:
        done.append((None, result))
