"""What has come and is not to be looked at before its moment."""

import threading
import time
import traceback
from collections import deque
from typing import Any, Callable, Deque, Dict, FrozenSet, List, Mapping, Optional, Sequence, Set, Tuple

import rospy
from rospy.topics import _SubscriberImpl

from planar_ros.lockstep.ticker import PROGRESS_TOPIC
from planar_ros.lockstep.transport import CLOCK_TOPIC, STATIC_TOPIC, UNCOUNTED, SerializedMessage

# Wall seconds that a message may be under way.
PATIENCE_SECONDS = 4.0
# Transforms are there before what refers to them is dealt with.
FIRST_TOPICS = (STATIC_TOPIC, "/tf")
# What is heard on these from nodes that are not in step decides nothing.
HARMLESS_TOPICS = frozenset((*FIRST_TOPICS, *UNCOUNTED, PROGRESS_TOPIC))
_receive = _SubscriberImpl.receive_callback


class _Channel:
    """The messages of one connection: how many have come, and those that wait.

    What waits from a connection ``before`` is not counted, and overdue.
    """

    def __init__(self, subscriber: Any, connection: Any, before: Optional["_Channel"]):
        self.subscriber, self.connection = subscriber, connection
        self.message_class = connection.protocol.recv_data_class
        self.received = 0
        self.waiting: Deque[SerializedMessage] = deque()
        self.latch: Any = None
        self._overdue: List[SerializedMessage] = [] if before is None else [*before._overdue, *before.waiting]
        self._socket = connection.socket

    def is_of(self, connection: Any) -> bool:
        """Whether it is that of a connection, and not of one that rospy has made anew in the same object."""
        return self.connection is connection and self._socket is connection.socket

    def pop(self, number: Optional[int]) -> List[SerializedMessage]:
        """What is overdue, and the first ``number`` of those that wait, or all."""
        number = len(self.waiting) if number is None else min(max(number, 0), len(self.waiting))
        overdue, self._overdue = self._overdue, []
        return overdue + [self.waiting.popleft() for _ in range(number)]


class MessageBuffer:
    """Hands messages on at once, or, while there are ``members``, those of members when they are released.

    ``holds_strangers``: whether then messages of nodes that are not in step wait as well. ``on_stranger`` is
    told of each such node, and on which topic it was heard, but for what is latched and for transforms.
    """

    def __init__(self, holds_strangers: bool, on_stranger: Callable[[str], None]):
        self.members: FrozenSet[str] = frozenset()
        self._holds_strangers, self._on_stranger = holds_strangers, on_stranger
        self._known: Set[Tuple[str, str]] = set()
        self._channels: Dict[Tuple[str, str], _Channel] = {}
        self._changed = threading.Condition()

    def install(self) -> None:
        """From now on all subscribers of this node receive by it."""

        def receive(subscriber: Any, frames: Sequence[Any], connection: Any) -> None:
            if frames and isinstance(frames[0], SerializedMessage):
                self._take(subscriber, frames, connection)
            else:  # a connection from before
                _receive(subscriber, frames, connection)

        _SubscriberImpl.receive_callback = receive

    def release(self, required: Mapping[Tuple[str, str], int]) -> List[str]:
        """Hands on what is ``required``, by topic and sender, and all that strangers have sent.

        Waits for what is still under way; returns what has not come in time, for people.
        """
        lost, due = [], []
        deadline = time.monotonic() + PATIENCE_SECONDS
        with self._changed:
            for (topic, sender), count in required.items():
                if not self._changed.wait_for(
                    lambda: self._has_come(topic, sender, count),  # noqa: B023
                    max(0.0, deadline - time.monotonic()),
                ):
                    lost.append(f"messages of {topic} from {sender} ({count} sent) have not come")
            for (topic, sender), channel in self._channels.items():
                handed_on = channel.received - len(channel.waiting)
                number = required.get((topic, sender), 0) - handed_on if sender in self.members else None
                frames = channel.pop(number)
                if frames:
                    due.append((topic, sender, channel, frames))
        for _, _, channel, frames in sorted(due, key=_order):
            _deliver(channel, frames)
        return lost

    def release_unsynchronized(self) -> None:
        """Hands on what nodes that are not in step have sent."""
        with self._changed:
            due = [
                (topic, sender, channel, channel.pop(None))
                for (topic, sender), channel in self._channels.items()
                if sender not in self.members
            ]
        for _, _, channel, frames in sorted(due, key=_order):
            _deliver(channel, frames)

    def release_all(self) -> None:
        """Hands on whatever waits, as there are no moments any more."""
        with self._changed:
            self.members = frozenset()
        self.release({})

    def _take(self, subscriber: Any, frames: Sequence[SerializedMessage], connection: Any) -> None:
        topic, sender = subscriber.resolved_name, connection.callerid_pub
        if self.members and sender not in self.members and not connection.is_latched:
            self._note_stranger(topic, sender)
        with self._changed:
            channel = self._channels.get((topic, sender))
            if channel is None or not channel.is_of(connection):
                channel = self._channels[topic, sender] = _Channel(subscriber, connection, channel)
            connection.latch = channel.latch  # rospy has put a frame there
            if self._holds(topic, sender):
                channel.waiting.extend(frames)
                channel.received += len(frames)
                self._changed.notify_all()
                return
        if not (topic == CLOCK_TOPIC and self.members):
            _deliver(channel, frames)
        with self._changed:  # only now: who waits for it may rely on it
            channel.received += len(frames)
            self._changed.notify_all()

    def _note_stranger(self, topic: str, sender: str) -> None:
        if (topic, sender) not in self._known and topic not in HARMLESS_TOPICS:
            self._known.add((topic, sender))
            self._on_stranger(f"{topic} came from {sender}, which is not in step")

    def _holds(self, topic: str, sender: str) -> bool:
        if topic in UNCOUNTED or not self.members:
            return False
        return self._holds_strangers or sender in self.members

    def _has_come(self, topic: str, sender: str, count: int) -> bool:
        channel = self._channels.get((topic, sender))
        if count <= (0 if channel is None else channel.received):
            return True
        return topic not in rospy.topics.get_topic_manager().subs  # not listened to any more


def _order(entry) -> Tuple[int, str, str]:
    topic, sender = entry[:2]
    return (FIRST_TOPICS.index(topic) if topic in FIRST_TOPICS else len(FIRST_TOPICS)), topic, sender


def _deliver(channel: _Channel, frames: Sequence[SerializedMessage]) -> None:
    """To the subscriber's callbacks: no more of the latest than its queue holds."""
    subscriber, connection = channel.subscriber, channel.connection
    if subscriber.queue_size is not None:
        frames = frames[-subscriber.queue_size :]
    messages = []
    for frame in frames:
        try:
            message = channel.message_class().deserialize(frame.data)
        except Exception:
            rospy.logerr("%s: a message is broken: %s", subscriber.resolved_name, traceback.format_exc())
            continue
        message._connection_header = connection.header
        messages.append(message)
    if messages and connection.is_latched:
        connection.latch = channel.latch = messages[-1]
    if messages and subscriber.callbacks:
        _receive(subscriber, messages, connection)
