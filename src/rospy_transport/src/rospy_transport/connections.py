"""What rospy knows about the topics and connections of this node; rospy publishes only their number."""

import fcntl
import operator
import select
import socket
import termios
from array import array
from typing import Any, Container, Dict, FrozenSet, List, Sequence, Set, Tuple

import rospy
from rospy.impl.registration import get_topic_manager
from rospy.impl.tcpros_base import TCPROSTransport
from rospy.impl.tcpros_pubsub import QueuedConnection, TCPROSPub

from rospy_transport.arrival import has_arrived
from rospy_transport.replacements import ImmediateConnection


class _OutgoingConnections:
    """Receiver, topic and connection of everything this node publishes.

    They are listed again when rospy has replaced the connections of a topic, as it does with each change.
    """

    def __init__(self) -> None:
        self._by_topic: List[List[Any]] = []
        self._listed: List[Tuple[str, str, Any]] = []
        self._closing, self._polled = select.poll(), self._listed

    def closed(self) -> List[Tuple[str, Any]]:
        """Return topic and connection of those that the receiver has closed."""
        listed = self()
        if self._polled is not listed:
            self._closing, self._polled = select.poll(), listed
            for _, _, connection in listed:
                if (number := _file_number(connection)) >= 0:
                    self._closing.register(number, select.POLLRDHUP)
        ended = {number for number, _ in self._closing.poll(0)}
        return [(topic, each) for _, topic, each in listed if ended and _file_number(each) in ended]

    def __call__(self) -> List[Tuple[str, str, Any]]:
        topics = list(get_topic_manager().pubs.items())
        by_topic = [publisher.connections for _, publisher in topics]
        is_same = len(by_topic) == len(self._by_topic) and all(map(operator.is_, by_topic, self._by_topic))
        if not is_same or sum(map(len, by_topic)) != len(self._listed):
            self._listed = [
                (connection.endpoint_id, topic, connection)
                for (topic, _), made in zip(topics, by_topic)
                for connection in made
            ]
            self._by_topic = by_topic
        return self._listed


_outgoing = _OutgoingConnections()


def outgoing() -> Sequence[Tuple[str, str, Any]]:
    """Return receiver, topic and connection of everything this node publishes.

    Needed to count the messages to each node; rospy makes a normal connection, without the replaced class,
    for a subscriber that connects before the queue size of the topic is known.
    """
    return _outgoing()


def drop_closed() -> bool:
    """Remove connections that their receivers have closed; return whether there were any.

    rospy notices only at the second message afterwards. Needed to wait for a receiver that subscribes again,
    as the official costmaps do when they are cleared, before it misses a message.
    """
    found = _outgoing.closed()
    for topic, connection in found:
        publisher = get_topic_manager().pubs.get(topic)
        if publisher is not None:
            publisher.remove_connection(connection)
    return bool(found)


def message_count(connection: Any) -> int:
    """Return the number of messages sent over a connection; needed to wait for them at the receiver."""
    if isinstance(connection, ImmediateConnection):
        return connection.message_count()
    return int(connection.stat_num_msg)


def topic_names() -> Tuple[FrozenSet[str], FrozenSet[str]]:
    """Return the published and the subscribed topics; needed to notice when they change."""
    manager = get_topic_manager()
    return frozenset(manager.pubs), frozenset(manager.subs)


def is_subscribed(topic: str) -> bool:
    """Return whether this node subscribes to a topic; needed to wait for no message of an ended subscription.

    Args:
        topic: Resolved name.
    """
    return topic in get_topic_manager().subs


def connected_publishers(subscriber: rospy.Subscriber) -> Set[str]:
    """Return the nodes from which a subscriber can receive.

    Needed because rospy counts a connection before its handshake, after which the name of the node is known.
    """
    return {connection.callerid_pub for connection in subscriber.impl.connections}


def is_connected(publisher: rospy.Publisher, node: str) -> bool:
    """Return whether a node is connected to a publisher; needed because others may be counted instead."""
    return bool(publisher.impl.has_connection(node))


def has_unprocessed() -> bool:
    """Return whether a subscription of this node has received bytes that are not read, or processed, yet.

    Needed to process what other nodes have sent before simulated time passes: on a busy machine a thread
    may wait for milliseconds between reading a message and its callback. It needs ``notes_receipt`` of
    ``install``.
    """
    made = [each for topic in list(get_topic_manager().subs.values()) for each in list(topic.connections)]
    ends: Dict[int, socket.socket] = {}
    readable = select.poll()
    for connection in made:
        end = getattr(connection, "socket", None)  # once: another thread may close it
        if end is not None and (number := end.fileno()) >= 0:
            ends[number] = end
            readable.register(number, select.POLLIN)
    if any(_bytes_in(ends[number], termios.FIONREAD) for number, _ in readable.poll(0)):
        return True
    # Afterwards, for a message is noted before it is taken from its socket.
    return any(getattr(each, "is_processing", False) for each in made)


def has_undelivered(receivers: Container[str]) -> bool:
    """Return whether messages of this node are under way to a receiver.

    Needed to distinguish a node that rests from one whose message has not arrived yet: on a busy machine the
    kernel takes milliseconds for it.

    Args:
        receivers: Names of the nodes that matter.
    """
    for receiver, _, connection in outgoing():
        end = getattr(connection, "socket", None) if receiver in receivers else None
        if end is not None and _bytes_in(end, termios.TIOCOUTQ) and not has_arrived(end):
            return True
    return False


def full_queues(publisher: rospy.Publisher) -> int:
    """Return for how many subscribers the next message drops an older one; rospy counts no drops."""
    return sum(_is_full(connection) for connection in publisher.impl.connections)


class OpenConnections:
    """The connections of a publisher that are open now; needed to end a node after its last message is sent.

    When a node ends, rospy closes its connections without sending the queued messages.

    Args:
        publisher: The publisher.
    """

    def __init__(self, publisher: rospy.Publisher):
        self._connections = [each for each in publisher.impl.connections if not each.done]
        self._is_latched = publisher.impl.latch is not None

    def are_sending(self) -> bool:
        """Return whether messages are queued; a latched one is, shortly after a connection is made."""
        return any(self._is_sending(each) for each in self._connections)

    def sockets(self) -> List[socket.socket]:
        """Return the sockets of the connections that are still open."""
        found = [getattr(each, "socket", None) for each in self._connections]
        return [each for each in found if each is not None]

    def _is_sending(self, connection: Any) -> bool:
        if isinstance(connection, ImmediateConnection):
            has_unsent = connection.has_unsent()
        else:
            has_unsent = bool(getattr(connection, "_queue", None))
        return has_unsent or (self._is_latched and connection.stat_num_msg == 0)


def connect(publisher: rospy.Publisher, node: str, end: socket.socket) -> Any:
    """Connect a subscriber to a publisher without handshake, for tests without a master.

    Args:
        publisher: The publisher.
        node: Name of the subscribing node.
        end: Connected socket whose other end the subscriber reads.

    Returns:
        The connection.
    """
    topic = publisher.resolved_name
    transport = TCPROSTransport(TCPROSPub(topic, publisher.data_class), topic)
    transport.set_socket(end, node)
    publisher.impl.add_connection(transport)
    return next(each for each in publisher.impl.connections if each.endpoint_id == node)


def _file_number(connection: Any) -> int:
    """File number of a connection's socket; negative without."""
    end = getattr(connection, "socket", None)
    return -1 if end is None else int(end.fileno())


def _bytes_in(end: socket.socket, queue: int) -> int:
    """Number of bytes in a queue of a socket, by its ioctl(2) request; 0 if the socket is closed."""
    size = array("i", [0])
    try:
        fcntl.ioctl(end.fileno(), queue, size)
    except (OSError, ValueError):
        return 0
    return size[0]


def _is_full(connection: Any) -> bool:
    if not isinstance(connection, QueuedConnection):
        return False
    return 0 < connection._queue_size <= len(connection._queue)
