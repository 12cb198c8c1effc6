"""Buffer of received messages until their logical instant."""

import threading
import time
from collections import deque
from typing import Callable, Deque, Dict, FrozenSet, List, Mapping, Optional, Sequence, Set, Tuple

from planar_ros.lockstep.ticker import PROGRESS_TOPIC
from planar_ros.lockstep.transport import CLOCK_TOPIC, STATIC_TOPIC, UNCOUNTED
from rospy_transport.connections import is_subscribed
from rospy_transport.replacements import IncomingConnection, SerializedMessage

# Longest time in transit of a message [wall s].
PATIENCE_SECONDS = 4.0
# Transforms are delivered before messages that need them.
FIRST_TOPICS = (STATIC_TOPIC, "/tf")
# Topics whose messages from unsynchronized nodes do not affect repeatability.
HARMLESS_TOPICS = frozenset((*FIRST_TOPICS, *UNCOUNTED, PROGRESS_TOPIC))


class _Channel:
    """Messages of one connection: how many were received, and those that wait.

    Messages left by a ``previous`` connection are not counted and are delivered first.
    """

    def __init__(self, connection: IncomingConnection, previous: Optional["_Channel"]):
        self.connection = connection
        self.received = 0
        self.waiting: Deque[SerializedMessage] = deque()
        self._overdue: List[SerializedMessage] = (
            [] if previous is None else [*previous._overdue, *previous.waiting]
        )

    def pop(self, number: Optional[int]) -> List[SerializedMessage]:
        """Remove and return overdue messages and the first ``number`` waiting ones, or all."""
        number = len(self.waiting) if number is None else min(max(number, 0), len(self.waiting))
        overdue, self._overdue = self._overdue, []
        return overdue + [self.waiting.popleft() for _ in range(number)]


class MessageBuffer:
    """Delivers messages at once, or, while nodes are synchronized, those of synchronized nodes on release.

    Its ``receive`` is given to ``rospy_transport.replacements.install``.

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
            channel.connection.deliver(frames)
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
            channel.connection.deliver(frames)

    def release_all(self) -> None:
        """Deliver all messages and stop buffering."""
        with self._changed:
            self.members = frozenset()
        self.release({})

    def receive(self, connection: IncomingConnection, frames: Sequence[SerializedMessage]) -> None:
        """Deliver the messages that a connection has received, or hold them."""
        topic, sender = connection.topic, connection.sender
        if self.members and sender not in self.members and not connection.is_latched:
            self._report_unsynchronized(topic, sender)
        with self._changed:
            channel = self._channels.get((topic, sender))
            if channel is None or channel.connection is not connection:
                channel = self._channels[topic, sender] = _Channel(connection, channel)
            if self._holds(topic, sender):
                channel.waiting.extend(frames)
                channel.received += len(frames)
                self._changed.notify_all()
                return
        if not (topic == CLOCK_TOPIC and self.members):
            channel.connection.deliver(frames)
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
        return not is_subscribed(topic)  # unsubscribed meanwhile


def _order(entry) -> Tuple[int, str, str]:
    topic, sender = entry[:2]
    return (FIRST_TOPICS.index(topic) if topic in FIRST_TOPICS else len(FIRST_TOPICS)), topic, sender
