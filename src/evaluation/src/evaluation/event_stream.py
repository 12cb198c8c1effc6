"""The stream of a run's events and its consumers."""

import threading
import traceback
from collections import defaultdict
from typing import Any, Callable, DefaultDict, Generic, List, Optional, Type, TypeVar

from evaluation.events import RunEvent

Event = TypeVar("Event", bound=RunEvent)


class EventStream:
    """Hands each event to the consumers of its type, one event at a time, in the order of subscription.

    Args:
        on_error: Called with the traceback of a consumer's error, which keeps the event from no other
            consumer; None: errors are raised.
    """

    def __init__(self, on_error: Optional[Callable[[str], None]] = None):
        self._on_error = on_error
        self._callbacks: DefaultDict[type, List[Callable[[Any], None]]] = defaultdict(list)
        self._lock = threading.RLock()

    def subscribe(self, kind: Type[Event], callback: Callable[[Event], None]) -> None:
        """Call ``callback`` with each event of exactly this type. It must be quick: the run waits for it."""
        self._callbacks[kind].append(callback)

    def has_consumers_of(self, kind: Type[RunEvent]) -> bool:
        """Whether there is a subscription to events of this type."""
        return kind in self._callbacks

    def publish(self, event: RunEvent) -> None:
        """Call all consumers of an event; any thread may do so."""
        with self._lock:
            for callback in self._callbacks.get(type(event), ()):
                try:
                    callback(event)
                except Exception:
                    if self._on_error is None:
                        raise
                    self._on_error(f"{type(event).__name__}: {traceback.format_exc()}")


class Latest(Generic[Event]):
    """Consumer that keeps the latest event of a type.

    Attributes:
        event: The event; None before the first.
    """

    def __init__(self, kind: Type[Event]):
        self.event: Optional[Event] = None
        self._kind = kind

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(self._kind, self._keep)

    def _keep(self, event: Event) -> None:
        self.event = event
