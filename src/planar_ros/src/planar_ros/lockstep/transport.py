"""Connections of synchronized nodes: messages are counted and sent in one batch for each logical instant."""

import threading
from collections import deque
from contextlib import suppress
from io import BytesIO
from typing import Any, ClassVar, Deque, Dict, FrozenSet, Iterator, List, Optional, Tuple

import rospy.topics
from rospy.impl.tcpros_pubsub import TCPROSSub

from planar_ros.node.connections import ImmediateConnection

INSTANT_TOPIC, ANSWER_TOPIC, CLOCK_TOPIC = "/simulation/moment", "/simulation/answer", "/clock"
STATIC_TOPIC = "/tf_static"
# Sent outside the batches: instants and answers carry the counts of all other messages, the clock the time.
UNCOUNTED = frozenset((INSTANT_TOPIC, ANSWER_TOPIC, CLOCK_TOPIC))
LENGTH_BYTES = 4
# Maximum number of messages to an observer in one batch.
MAX_BATCH = 10
# Counts by receiver and topic of connections that may have been removed since.
_last_counts: Dict[Tuple[str, str], int] = {}
_init = TCPROSSub.__init__


class LockstepConnection(ImmediateConnection):
    """Connection that batches messages to synchronized nodes until the answer to an instant, and drops none.

    Messages to observers, and the clock, are batched as well if they are sent by ``batching_thread``, since a
    send costs as much as a message. That thread calls ``flush`` before it waits for anything.

    Attributes:
        members: Synchronized nodes; without any, the connection is a normal one.
        observers: Unsynchronized nodes that must receive all messages.
        batching_thread: Identifier of the thread that batches messages to observers.
        count: Number of messages sent.
        receiver: Name of the receiving node.
    """

    members: ClassVar[FrozenSet[str]] = frozenset()
    observers: ClassVar[FrozenSet[str]] = frozenset()
    batching_thread: ClassVar[Optional[int]] = None
    _unsent: ClassVar[Deque["LockstepConnection"]] = deque()

    def __init__(self, connection, queue_size: int):
        self.count = 0
        self.receiver, self._topic = connection.endpoint_id, connection.protocol.resolved_name
        self._batch: List[bytes] = []
        # Reentrant, since a message may be sent while others are; the order is that of the calls.
        self._batch_lock = threading.RLock()
        super().__init__(connection, queue_size)

    def write_data(self, data) -> bool:
        is_member = self.receiver in self.members
        if is_member and self._topic == CLOCK_TOPIC:
            return True
        with self._batch_lock:
            self.count += 1
            if is_member and self._topic not in UNCOUNTED:
                return self._append(data)
            if self._may_batch() and len(self._batch) < MAX_BATCH:
                return self._append(data)
            self._send_batch()
            return super().write_data(data)

    @classmethod
    def flush_all(cls) -> None:
        """Send all batched messages in order."""
        with suppress(IndexError):  # two threads may call it
            while True:
                cls._unsent.popleft().flush()

    def flush(self) -> None:
        """Send the batch; an error is raised by the next message, where rospy expects it."""
        with self._batch_lock:
            try:
                self._send_batch()
            except Exception as error:
                self._error = error

    def _may_batch(self) -> bool:
        if self.batching_thread is None or threading.get_ident() != self.batching_thread:
            return False
        return self._topic == CLOCK_TOPIC or (
            self.receiver in self.observers and self._topic not in UNCOUNTED
        )

    def _append(self, data) -> bool:
        if self._error or self._connection.done:
            return super().write_data(data)
        if self._topic != CLOCK_TOPIC:
            self._queue_size = 0  # rospy's value for an unlimited queue
        if not self._batch:
            self._unsent.append(self)
        self._batch.append(data)
        return True

    def _send_batch(self) -> None:
        if self._batch:
            batch, self._batch = b"".join(self._batch), []
            super().write_data(batch)


class SerializedMessage:
    """A received message that is not deserialized yet."""

    __slots__ = ("_connection_header", "data")

    def __init__(self, data: bytes):
        self.data = data
        self._connection_header: Dict[str, str] = {}


def install() -> None:
    """Use these connections for this node from now on."""
    rospy.topics.QueuedConnection = LockstepConnection
    TCPROSSub.__init__ = _init_for_serialized


def _init_for_serialized(self: TCPROSSub, *given: Any, **named: Any) -> None:
    """Receive serialized messages; earlier connections, such as that of /clock, still receive messages."""
    _init(self, *given, **named)
    self.read_messages = _read_serialized


def _read_serialized(b: BytesIO, msg_queue: List[SerializedMessage], sock: object) -> None:
    """Split received bytes into serialized messages, which a MessageBuffer deserializes."""
    end, at = b.tell(), 0
    with b.getbuffer() as view:
        while end - at >= LENGTH_BYTES:
            start = at + LENGTH_BYTES
            size = int.from_bytes(view[at:start], "little")
            if end - start < size:
                break
            msg_queue.append(SerializedMessage(bytes(view[start : start + size])))
            at = start + size
        rest = bytes(view[at:end]) if at else b""
    if at:
        b.seek(0)
        b.truncate(0)
        b.write(rest)


def connections() -> Iterator[Tuple[str, str, Any]]:
    """Yield receiver, topic and connection of everything this node publishes.

    rospy makes a normal connection for a subscriber that connects before the queue size of the topic is
    known.
    """
    for topic, publisher in list(rospy.topics.get_topic_manager().pubs.items()):
        for connection in publisher.connections:
            yield connection.endpoint_id, topic, connection


def flush() -> None:
    """Send all batched messages."""
    LockstepConnection.flush_all()


def batch_sends() -> None:
    """Batch the calling thread's messages to observers from now on, until it calls ``flush``."""
    LockstepConnection.batching_thread = threading.get_ident()


def remember_counts(topic: str) -> None:
    """Remember the number of messages sent on a topic whose subscribers are about to disconnect.

    rospy removes closed connections twice a second, and so possibly before the answer to the instant.
    """
    _last_counts.update(
        ((receiver, name), _count_of(connection))
        for receiver, name, connection in connections()
        if name == topic
    )


def sent(sender: str) -> Dict[str, int]:
    """Return the number of messages sent to each synchronized node, by ``sender receiver topic``."""
    members = LockstepConnection.members
    now = {
        (receiver, topic): _count_of(connection)
        for receiver, topic, connection in connections()
        if receiver in members and topic not in UNCOUNTED
    }
    for channel, count in list(_last_counts.items()):
        if channel in now:
            del _last_counts[channel]
        elif channel[0] in members:
            now[channel] = count
    return {f"{sender} {receiver} {topic}": count for (receiver, topic), count in now.items()}


def _count_of(connection: Any) -> int:
    is_counted = isinstance(connection, LockstepConnection)
    return int(connection.count if is_counted else connection.stat_num_msg)


def topology() -> int:
    """Return a number that changes with the topics of the node."""
    manager = rospy.topics.get_topic_manager()
    return hash((frozenset(manager.pubs), frozenset(manager.subs))) & 0xFFFFFFFF
