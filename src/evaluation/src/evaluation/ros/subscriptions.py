"""Subscriptions of this process: one a topic, which feeds all observers.

rospy shares the connection between the subscribers of a process, but hands what has been received on to those
only that are there by then: of latched messages, which come first, later subscribers would miss all but the
last. Their observers would judge by fewer messages than others have recorded.
"""

import threading
import traceback
from contextlib import contextmanager
from typing import Any, Callable, Dict, Iterator, List

import rospy

Callback = Callable[[Any], None]


class _Topic:
    """The subscription of a topic and its observers.

    Args:
        name: Resolved name.
        kind: Message class.
    """

    def __init__(self, name: str, kind: type):
        self._name, self._kind = name, kind
        self._callbacks: List[Callback] = []
        # Last latched message of each publisher.
        self._latched: Dict[str, Any] = {}
        self._lock = threading.RLock()
        self._is_open = False

    def add(self, callback: Callback) -> None:
        """Add an observer; it receives the last latched messages."""
        with self._lock:
            self._callbacks.append(callback)
            for message in self._latched.values():
                self._call(callback, message)

    def open(self) -> None:
        """Subscribe, once."""
        if not self._is_open:
            self._is_open = True
            rospy.Subscriber(self._name, self._kind, self._on_message, queue_size=None, tcp_nodelay=True)

    def _on_message(self, message: Any) -> None:
        with self._lock:
            header = getattr(message, "_connection_header", None) or {}
            if header.get("latching") == "1":
                self._latched[header.get("callerid", "")] = message
            for callback in self._callbacks:
                self._call(callback, message)

    def _call(self, callback: Callback, message: Any) -> None:
        """Call an observer; its error keeps the message from no other one."""
        try:
            callback(message)
        except Exception:
            rospy.logerr("%s: bad callback: %s", self._name, traceback.format_exc())


_topics: Dict[str, _Topic] = {}
_lock = threading.RLock()
_is_collecting = False


def subscribe(topic: str, kind: type, callback: Callback) -> None:
    """Subscribe without losing messages, however long the callback is delayed.

    rospy keeps one queue for each topic and process, with the length requested last: a short one of another
    subscriber in this process would also cut this one.

    Args:
        topic: Topic, relative to the namespace.
        kind: Message class.
        callback: Called with each message.
    """
    name = rospy.resolve_name(topic)
    with _lock:
        entry = _topics.setdefault(name, _Topic(name, kind))
        entry.add(callback)
        if not _is_collecting:
            entry.open()


@contextmanager
def subscribing_together() -> Iterator[None]:
    """Context in which observers subscribe; its end opens the subscriptions, so that no message is missed."""
    global _is_collecting
    with _lock:
        _is_collecting = True
    try:
        yield
    finally:
        with _lock:
            _is_collecting = False
            for entry in tuple(_topics.values()):
                entry.open()
