"""What takes long, done beside: a tool asks other nodes and programs without waiting for them."""

import threading
from typing import Any, Callable, List, Optional, Tuple

from cockpit.errors import CockpitError


class BackgroundCall:
    """One thing at a time, in a thread that nobody waits for."""

    def __init__(self) -> None:
        self._done: List[Tuple[Optional[Exception], Any]] = []
        self._thread: Optional[threading.Thread] = None

    @property
    def is_busy(self) -> bool:
        return self._thread is not None and self._thread.is_alive()

    def start(self, do: Callable[[], Any]) -> None:
        """Raises CockpitError if the one before is not done yet."""
        if self.is_busy:
            raise CockpitError("the answer before is still awaited")
        self.restart(do)

    def restart(self, do: Callable[[], Any]) -> None:
        """Instead of the one before: whatever comes of that is not taken any more."""
        done: List[Tuple[Optional[Exception], Any]] = []
        self._done = done
        self._thread = threading.Thread(target=_work, args=(do, done), daemon=True)
        self._thread.start()

    def results(self) -> List[Any]:
        """What has come of it since the last call, if anything. Raises what it has raised."""
        if not self._done:
            return []
        error, result = self._done.pop()
        if error is not None:
            raise error
        return [result]


def _work(do: Callable[[], Any], done: List[Tuple[Optional[Exception], Any]]) -> None:
    try:
        result = do()
    except Exception as error:  # handed on to who asks
        done.append((error, None))
    else:
        done.append((None, result))
