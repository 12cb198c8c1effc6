"""Buffer of received messages until their logical instant."""

import threading
import time
import traceback
from collections import deque
from typing import Any, Callable, Deque, Dict, FrozenSet, List, Mapping, Optional, Sequence, Set, Tuple

import rospy
from rospy.topics import _SubscriberImpl

from planar_ros.lockstep.ticker import PROGRESS_TOPIC
from planar_ros.lockstep.transport import CLOCK_TOPIC, STATIC_TOPIC, UNCOUNTED, SerializedMessage

# Longest time in transit of a message [wall s].
PATIENCE_SECONDS = 4.0
# Transforms are delivered before messages that need them.
FIRST_TOPICS = (STATIC_TOPIC, "/tf")
# Topics whose messages from unsynchronized nodes do not affect repeatability.
HARMLESS_TOPICS = frozenset((*FIRST_TOPICS, *UNCOUNTED, PROGRESS_TOPIC))
_receive = _SubscriberImpl.receive_callback


class _Channel:
    """Messages of one connection: how many were received, and those that wait.

    Messages left by a ``previous`` connection are not counted and are delivered first.
    """

    def __init__(self, subscriber: Any, connection: Any, previous: Optional["_Channel"]):
        self.subscriber, self.connection = subscriber, connection
        self.message_class = connection.protocol.recv_data_class
        self.received = 0
        self.waiting: Deque[SerializedMessage] = deque()
        self.latch: Any = None
        self._overdue: List[SerializedMessage] = (
            [] if previous is None else [*previous._overdue, *previous.waiting]
        )
        self._socket = connection.socket

    def is_of(self, connection: Any) -> bool:
        """Return whether the channel belongs to a connection; rospy may reuse the object for a new one."""
        return self.connection is connection and self._socket is connection.socket

    def pop(self, number: Optional[int]) -> List[SerializedMessage]:
        """Remove and return overdue messages and the first ``number`` waiting ones, or all."""
        number = len(self.waiting) if number is None else min(max(number, 0), len(self.waiting))
        overdue, self._overdue = self._overdue, []
        return overdue + [self.waiting.popleft() for _ in range(number)]


class MessageBuffer:
    """Delivers messages at once, or, while nodes are synchronized, those of synchronized nodes on release.

    Attributes:
        members: Synchronized nodes.
    """

    def __init__(self, holds_unsynchronized: bool, on_unsynchronized: Callable[[str], None]):
        """Make a buffer.

        Args:
            holds_unsynchronized: Whether messages of unsynchronized nodes wait for an instant as well.
            on_unsynchronized: Called once with a description of each unsynchronized publisher, except for
                latched messages and transforms.
        """
        self.members: FrozenSet[str] = frozenset()
        self._holds_unsynchronized, self._on_unsynchronized = holds_unsynchronized, on_unsynchronized
        self._reported: Set[Tuple[str, str]] = set()
        self._channels: Dict[Tuple[str, str], _Channel] = {}
        self._changed = threading.Condition()

    def install(self) -> None:
        """Deliver the messages of all subscribers of this node through this buffer."""

        def receive(subscriber: Any, frames: Sequence[Any], connection: Any) -> None:
            if frames and isinstance(frames[0], SerializedMessage):
                self._on_receive(subscriber, frames, connection)
            else:  # a connection made before
                _receive(subscriber, frames, connection)

        _SubscriberImpl.receive_callback = receive

    def release(self, required: Mapping[Tuple[str, str], int]) -> List[str]:
        """Deliver the required messages, and all of unsynchronized nodes.

        Args:
            required: Number of messages received so far, by topic and sender; waits for those in transit.

        Returns:
            Descriptions of messages that did not arrive in time.
        """
        missing, due = [], []
        deadline = time.monotonic() + PATIENCE_SECONDS
        with self._changed:
            for (topic, sender), count in required.items():
                if not self._changed.wait_for(
                    lambda: self._has_arrived(topic, sender, count),  # noqa: B023
                    max(0.0, deadline - time.monotonic()),
                ):
                    missing.append(f"messages on {topic} from {sender} did not arrive ({count} sent)")
            for (topic, sender), channel in self._channels.items():
                delivered = channel.received - len(channel.waiting)
                number = required.get((topic, sender), 0) - delivered if sender in self.members else None
                frames = channel.pop(number)
                if frames:
                    due.append((topic, sender, channel, frames))
        for _, _, channel, frames in sorted(due, key=_order):
            _deliver(channel, frames)
        return missing

    def release_unsynchronized(self) -> None:
        """Deliver the messages of unsynchronized nodes."""
        with self._changed:
            due = [
                (topic, sender, channel, channel.pop(None))
                for (topic, sender), channel in self._channels.items()
                if sender not in self.members
            ]
        for _, _, channel, frames in sorted(due, key=_order):
            _deliver(channel, frames)

    def release_all(self) -> None:
        """Deliver all messages and stop buffering."""
        with self._changed:
            self.members = frozenset()
        self.release({})

    def _on_receive(self, subscriber: Any, frames: Sequence[SerializedMessage], connection: Any) -> None:
        topic, sender = subscriber.resolved_name, connection.callerid_pub
        if self.members and sender not in self.members and not connection.is_latched:
            self._report_unsynchronized(topic, sender)
        with self._changed:
            channel = self._channels.get((topic, sender))
            if channel is None or not channel.is_of(connection):
                channel = self._channels[topic, sender] = _Channel(subscriber, connection, channel)
            connection.latch = channel.latch  # rospy has set it to a serialized message
            if self._holds(topic, sender):
                channel.waiting.extend(frames)
                channel.received += len(frames)
                self._changed.notify_all()
                return
        if not (topic == CLOCK_TOPIC and self.members):
            _deliver(channel, frames)
        with self._changed:  # only after delivery, since waiting threads rely on it
            channel.received += len(frames)
            self._changed.notify_all()

    def _report_unsynchronized(self, topic: str, sender: str) -> None:
        if (topic, sender) not in self._reported and topic not in HARMLESS_TOPICS:
            self._reported.add((topic, sender))
            self._on_unsynchronized(f"received {topic} from the unsynchronized node {sender}")

    def _holds(self, topic: str, sender: str) -> bool:
        if topic in UNCOUNTED or not self.members:
            return False
        return self._holds_unsynchronized or sender in self.members

    def _has_arrived(self, topic: str, sender: str, count: int) -> bool:
        channel = self._channels.get((topic, sender))
        if count <= (0 if channel is None else channel.received):
            return True
        return topic not in rospy.topics.get_topic_manager().subs  # unsubscribed meanwhile


def _order(entry) -> Tuple[int, str, str]:
    topic, sender = entry[:2]
    return (FIRST_TOPICS.index(topic) if topic in FIRST_TOPICS else len(FIRST_TOPICS)), topic, sender


def _deliver(channel: _Channel, frames: Sequence[SerializedMessage]) -> None:
    """Call the callbacks of a subscriber with the latest messages, at most its queue size."""
    subscriber, connection = channel.subscriber, channel.connection
    if subscriber.queue_size is not None:
        frames = frames[-subscriber.queue_size :]
    messages = []
    for frame in frames:
        try:
            message = channel.message_class().deserialize(frame.data)
        except Exception:
            rospy.logerr(
                "%s: cannot deserialize a message: %s", subscriber.resolved_name, traceback.format_exc()
            )
            continue
        message._connection_header = connection.header
        messages.append(message)
    if messages and connection.is_latched:
        connection.latch = channel.latch = messages[-1]
    if messages and subscriber.callbacks:
        _receive(subscriber, messages, connection)
