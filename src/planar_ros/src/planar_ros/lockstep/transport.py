"""rospy's connections, so that messages between nodes in step are counted and come in one piece a moment."""

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
# They go by themselves: the first two say how many of all others there are, the moment is the time.
UNCOUNTED = frozenset((INSTANT_TOPIC, ANSWER_TOPIC, CLOCK_TOPIC))
LENGTH_BYTES = 4
# Of messages to those who only look on, so many at most are sent in one piece.
MAX_BATCH = 10
# By receiver and topic, of connections that may have been removed since.
_last_counts: Dict[Tuple[str, str], int] = {}
_init = TCPROSSub.__init__


class LockstepConnection(ImmediateConnection):
    """Towards a node in step it keeps what is sent back until the moment's answer, and loses nothing.

    ``members``: the nodes in step with this one; none, and it is a connection as any other.
    ``audience``: nodes that only look on, and miss nothing either. What the thread ``saver`` sends to them,
    and the clock to anybody, is kept back too, for a send costs as much as the message: until it calls
    ``flush``, which it does before it waits for anything.
    """

    members: ClassVar[FrozenSet[str]] = frozenset()
    observers: ClassVar[FrozenSet[str]] = frozenset()
    batching_thread: ClassVar[Optional[int]] = None
    _full: ClassVar[Deque["LockstepConnection"]] = deque()

    def __init__(self, connection, queue_size: int):
        self.count = 0
        self.receiver, self._topic = connection.endpoint_id, connection.protocol.resolved_name
        self._kept: List[bytes] = []
        # Reentrant, for a message may be sent while others are: the order is that of the calls.
        self._keeping = threading.RLock()
        super().__init__(connection, queue_size)

    def write_data(self, data) -> bool:
        is_in_step = self.receiver in self.members
        if is_in_step and self._topic == CLOCK_TOPIC:
            return True
        with self._keeping:
            self.count += 1
            if is_in_step and self._topic not in UNCOUNTED:
                return self._keep(data)
            if self._may_save() and len(self._kept) < MAX_BATCH:
                return self._keep(data)
            self._send_kept()
            return super().write_data(data)

    @classmethod
    def flush_all(cls) -> None:
        """Sends whatever has been kept back, first what was first."""
        with suppress(IndexError):  # two threads may be at it
            while True:
                cls._full.popleft().flush()

    def flush(self) -> None:
        """Sends what was kept back; an error is left to the next message, where rospy expects it."""
        with self._keeping:
            try:
                self._send_kept()
            except Exception as error:
                self._error = error

    def _may_save(self) -> bool:
        if self.batching_thread is None or threading.get_ident() != self.batching_thread:
            return False
        return self._topic == CLOCK_TOPIC or (
            self.receiver in self.observers and self._topic not in UNCOUNTED
        )

    def _keep(self, data) -> bool:
        if self._error or self._connection.done:
            return super().write_data(data)
        if self._topic != CLOCK_TOPIC:
            self._queue_size = 0  # rospy's word for: drop nothing
        if not self._kept:
            self._full.append(self)
        self._kept.append(data)
        return True

    def _send_kept(self) -> None:
        if self._kept:
            kept, self._kept = b"".join(self._kept), []
            super().write_data(kept)


class SerializedMessage:
    """A message as it came, not yet deserialized."""

    __slots__ = ("_connection_header", "data")

    def __init__(self, data: bytes):
        self.data = data
        self._connection_header: Dict[str, str] = {}


def install() -> None:
    """From now on this node's connections are such."""
    rospy.topics.QueuedConnection = LockstepConnection
    TCPROSSub.__init__ = _init_for_frames


def _init_for_frames(self: TCPROSSub, *given: Any, **named: Any) -> None:
    """A connection from before, as that of /clock may be, goes on with messages."""
    _init(self, *given, **named)
    self.read_messages = _read_frames


def _read_frames(b: BytesIO, msg_queue: List[SerializedMessage], sock: object) -> None:
    """Cuts what has come into frames, and leaves it to an Inbox to make messages of them."""
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
    """Receiver, topic and connection of all that this node sends by.

    rospy makes a plain one for a subscriber that connects before the topic has been told its queue's size.
    """
    for topic, publisher in list(rospy.topics.get_topic_manager().pubs.items()):
        for connection in publisher.connections:
            yield connection.endpoint_id, topic, connection


def flush() -> None:
    """Sends whatever has been kept back."""
    LockstepConnection.flush_all()


def batch_sends() -> None:
    """From now on the calling thread's messages to those who look on are sent when it calls ``flush``."""
    LockstepConnection.batching_thread = threading.get_ident()


def remember_counts(topic: str) -> None:
    """What has been sent on a topic until now is told although all who listen are about to hang up.

    rospy removes their connections twice a second, and so perhaps before the moment's answer.
    """
    _last_counts.update(
        ((receiver, name), _count_of(connection))
        for receiver, name, connection in connections()
        if name == topic
    )


def sent(sender: str) -> Dict[str, int]:
    """How many messages have gone out on each connection to a node in step, by "sender receiver topic"."""
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
    """Another number for other topics."""
    manager = rospy.topics.get_topic_manager()
    return hash((frozenset(manager.pubs), frozenset(manager.subs))) & 0xFFFFFFFF
