"""Detect that simulated time has stopped, and report why."""

import threading
import time
from typing import Callable, Optional, Sequence

from evaluation.event_stream import EventStream
from evaluation.events import ClockAdvanced, NodesAwaited

# Wall-clock time after which a stopped clock is reported [s].
STANDING_SECONDS = 3.0


class ClockMonitor:
    """Detects that simulated time has stopped and asks why.

    Args:
        log: Called with the reason when the clock has stopped.
        explain: Returns why the clock has stopped; called in a thread with the nodes that the simulator has
            published to wait for.
        patience: Wall-clock time without progress after which the clock counts as stopped [s].

    Attributes:
        reason: Why simulated time stands still, in words; None while it advances.
    """

    def __init__(
        self,
        log: Callable[[str], None],
        explain: Callable[[Sequence[str]], str],
        patience: float = STANDING_SECONDS,
    ):
        self.reason: Optional[str] = None
        self._log, self._explain, self._patience = log, explain, patience
        self._stamp: Optional[float] = None
        self._since = 0.0
        self._is_querying = False
        self._awaited: Sequence[str] = ()

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(ClockAdvanced, self._on_clock)
        events.subscribe(NodesAwaited, self._on_awaited)

    def _on_awaited(self, event: NodesAwaited) -> None:
        self._awaited = event.names

    def _on_clock(self, event: ClockAdvanced) -> None:
        if event.stamp != self._stamp:
            self._stamp, self._since, self.reason = event.stamp, time.monotonic(), None

    def check(self) -> None:
        """Check the clock; to be called periodically."""
        stands = self._stamp is not None and time.monotonic() - self._since > self._patience
        if stands and self.reason is None and not self._is_querying:
            self._is_querying = True
            threading.Thread(target=self._query, args=(self._stamp,), daemon=True).start()

    def _query(self, stamp: float) -> None:
        why = self._explain(self._awaited)
        if stamp == self._stamp:
            self.reason = f"simulated time stands still at {stamp:.1f} s: {why}"
            self._log(self.reason)
        self._is_querying = False
