"""The attributes of rospy that are replaced, all by ``install``, and what replaces them.

rospy has no parameters or hooks for what they change.
"""

import socket
import traceback
from contextlib import suppress
from io import BytesIO
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Type

import rospy.topics
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_base import TCPROSTransport, TCPServer
from rospy.impl.tcpros_pubsub import QueuedConnection, TCPROSSub
from rospy.impl.tcpros_service import ServiceImpl
from rospy.topics import _SubscriberImpl

LISTEN_BACKLOG = 128
LENGTH_BYTES = 4
# rospy's value for an unlimited queue.
UNLIMITED = 0


class ImmediateConnection(QueuedConnection):
    """Connection of a publisher with a queue that sends at once what the socket accepts.

    rospy passes every message to a thread of each subscriber, which costs a node with many messages more than
    all its other work. A slow subscriber still blocks nothing: its thread sends what does not fit into the
    socket's buffer. The kernel sends a message at once as well; otherwise it may wait up to 40 ms for the
    acknowledgement of the one before.

    Attributes:
        receiver: Name of the receiving node.
        topic: Resolved name of the topic.
    """

    def __init__(self, connection: Any, queue_size: int):
        self.receiver, self.topic = connection.endpoint_id, connection.protocol.resolved_name
        # Rest of a message that was sent partially; unlike queued messages it must not be dropped.
        self._rest = b""
        self._is_relaying = False
        self._queue: List[bytes]
        self._error: Optional[Exception]
        with suppress(OSError):  # not a TCP connection, or closed
            connection.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        super().__init__(connection, queue_size)

    def write_data(self, data: bytes) -> bool:
        """Send a serialized message.

        Args:
            data: One or more messages, each with its length.

        Raises:
            Exception: An earlier message could not be sent; rospy then closes the connection.
        """
        with self._lock:
            is_free = not (self._queue or self._rest or self._is_relaying or self._error)
            if is_free and not self._connection.done:
                sent = self._send(data)
                if sent == len(data):
                    return True
                if sent:
                    self._rest = bytes(data[sent:])
                    self._cond_data_available.notify()
                    return True
        return bool(super().write_data(data))

    @property
    def is_broken(self) -> bool:
        """Whether the connection has ended, or its next message raises an error."""
        return bool(self._error or self._connection.done)

    def has_unsent(self) -> bool:
        """Return whether messages are waiting to be sent."""
        return bool(self._queue or self._rest or self._is_relaying)

    def message_count(self) -> int:
        """Return the number of messages sent."""
        return int(self._connection.stat_num_msg)

    def keep_all(self) -> None:
        """Drop no message from now on, however slow the receiver is."""
        self._queue_size = UNLIMITED

    def fail(self, error: Exception) -> None:
        """Raise an error at the next message, where rospy expects it."""
        self._error = error

    def _send(self, data: bytes) -> int:
        """Return how many bytes the socket accepted without blocking; errors are left to the thread."""
        try:
            sent: int = self._connection.socket.send(data, socket.MSG_DONTWAIT)
        except (OSError, AttributeError):
            return 0
        self._connection.stat_bytes += sent
        self._connection.stat_num_msg += 1
        return sent

    def _run(self) -> None:
        while not self._connection.done:
            with self._lock:
                while not (self._queue or self._rest or self._connection.done):
                    self._cond_data_available.wait()
                waiting = [self._rest, *self._queue] if self._rest else self._queue
                self._rest, self._queue, self._is_relaying = b"", [], True
            for data in waiting:
                try:
                    self._connection.write_data(data)
                except Exception as error:
                    with self._lock:
                        self._error = error
            with self._lock:
                self._is_relaying = False


class SerializedMessage:
    """A received message that is not deserialized yet."""

    __slots__ = ("_connection_header", "data")

    def __init__(self, data: bytes):
        self.data = data
        self._connection_header: Dict[str, str] = {}


class IncomingConnection:
    """Connection over which this node receives the serialized messages of a topic from one publisher.

    Attributes:
        topic: Resolved name of the topic.
        sender: Name of the publishing node.
        is_latched: Whether the publisher latches its last message.
    """

    __slots__ = ("topic", "sender", "is_latched", "_subscriber", "_connection", "_socket", "_kind", "_latch")

    def __init__(self, subscriber: Any, connection: Any):
        self.topic, self.sender = subscriber.resolved_name, connection.callerid_pub
        self.is_latched = connection.is_latched
        self._subscriber, self._connection = subscriber, connection
        self._socket, self._kind = connection.socket, connection.protocol.recv_data_class
        self._latch: Any = None

    @classmethod
    def of(cls, subscriber: Any, connection: Any) -> "IncomingConnection":
        """Return the object of a connection; rospy may reuse its own for a new socket."""
        found: Optional[IncomingConnection] = getattr(connection, "incoming", None)
        if found is None or found._socket is not connection.socket:
            found = connection.incoming = cls(subscriber, connection)
        connection.latch = found._latch  # rospy has set it to a serialized message
        return found

    def deliver(self, frames: Sequence[SerializedMessage]) -> None:
        """Call the callbacks of the subscriber with the latest messages, at most its queue size."""
        subscriber, connection = self._subscriber, self._connection
        if subscriber.queue_size is not None:
            frames = frames[-subscriber.queue_size :]
        messages = []
        for frame in frames:
            try:
                message = self._kind().deserialize(frame.data)
            except Exception:
                rospy.logerr("%s: cannot deserialize a message: %s", self.topic, traceback.format_exc())
                continue
            message._connection_header = connection.header
            messages.append(message)
        if messages and self.is_latched:
            connection.latch = self._latch = messages[-1]
        if messages and subscriber.callbacks:
            _receive_callback(subscriber, messages, connection)


Receive = Callable[[IncomingConnection, Sequence[SerializedMessage]], None]
BeforeCall = Callable[[str, Mapping[str, str]], None]
_create_server_sock, _publisher_update = TCPServer._create_server_sock, RegManager.publisher_update
_init_sub, _receive_callback = TCPROSSub.__init__, _SubscriberImpl.receive_callback
_handle_request = ServiceImpl._handle_request
_receive_once = TCPROSTransport.receive_once


def install(
    connections: Optional[Type[ImmediateConnection]] = None,
    receive: Optional[Receive] = None,
    before_call: Optional[BeforeCall] = None,
    notes_receipt: bool = False,
) -> None:
    """Replace attributes of rospy in this process; further calls add to the earlier ones.

    Every call makes the node accept many simultaneous connections and connect to all publishers: rospy's
    backlog is five, and a sixth connection is retried by TCP only after a second; and if a publisher
    registers while the node subscribes, the master's update may arrive before the older answer to the
    subscription, whose list rospy would then use. Call it before ``rospy.init_node``.

    Args:
        connections: Class of the connections that publishers with a queue make from now on: rospy's send
            each message in a separate thread.
        receive: Called with the serialized messages of all subscribers that connect from now on, instead of
            their callbacks; it calls ``IncomingConnection.deliver`` then or later. rospy delivers messages
            only when they arrive.
        before_call: Called with the resolved name of a service and the connection header of the caller,
            before the service's callback and in its thread; it may wait. rospy's callback does not know the
            service's name.
        notes_receipt: Have all subscribers note whether they are reading or processing a message, for
            ``connections.has_unprocessed``.
    """
    TCPServer._create_server_sock = _create_server_sock_with_backlog
    RegManager.publisher_update = _publisher_update_with_queued
    if connections is not None:
        rospy.topics.QueuedConnection = connections
    if receive is not None:
        TCPROSSub.__init__ = _init_sub_for_serialized
        _SubscriberImpl.receive_callback = _receiving(receive)
    if before_call is not None:
        ServiceImpl._handle_request = _handling_after(before_call)
    if notes_receipt:
        TCPROSTransport.receive_once = _receive_once_noted


def uninstall() -> None:
    """Restore the attributes of rospy, for tests."""
    TCPServer._create_server_sock, RegManager.publisher_update = _create_server_sock, _publisher_update
    rospy.topics.QueuedConnection = QueuedConnection
    TCPROSSub.__init__, _SubscriberImpl.receive_callback = _init_sub, _receive_callback
    ServiceImpl._handle_request = _handle_request
    TCPROSTransport.receive_once = _receive_once


def _create_server_sock_with_backlog(self: TCPServer) -> socket.socket:
    server: socket.socket = _create_server_sock(self)
    server.listen(LISTEN_BACKLOG)
    return server


def _publisher_update_with_queued(self: RegManager, topic: str, uris: Sequence[str]) -> None:
    """Queue an update with the publishers of all queued ones."""
    with self.cond:
        queued = [uri for name, earlier in self.updates if name == topic for uri in earlier]
        _publisher_update(self, topic, list(dict.fromkeys((*queued, *uris))))


def _init_sub_for_serialized(self: TCPROSSub, *given: Any, **named: Any) -> None:
    """Receive serialized messages; earlier connections, such as that of /clock, still receive messages."""
    _init_sub(self, *given, **named)
    self.read_messages = _read_serialized


def _read_serialized(b: BytesIO, msg_queue: List[SerializedMessage], sock: object) -> None:
    """Split received bytes into serialized messages."""
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


def _receive_once_noted(self: TCPROSTransport) -> Any:
    """Note that a message is processed before it is taken from the socket, until the next is waited for.

    In between another thread would find neither the bytes in the socket nor what the callback does.
    """
    self.is_processing = False
    with suppress(OSError, AttributeError):  # closed: rospy notices
        self.socket.recv(1, socket.MSG_PEEK)
    self.is_processing = True
    return _receive_once(self)


def _receiving(receive: Receive) -> Callable[[Any, Sequence[Any], Any], None]:
    def receive_callback(subscriber: Any, frames: Sequence[Any], connection: Any) -> None:
        if frames and isinstance(frames[0], SerializedMessage):
            receive(IncomingConnection.of(subscriber, connection), frames)
        else:  # a connection made before
            _receive_callback(subscriber, frames, connection)

    return receive_callback


def _handling_after(before_call: BeforeCall) -> Callable[[Any, Any, Any], None]:
    def handle_request(service: Any, transport: Any, request: Any) -> None:
        before_call(service.resolved_name, getattr(request, "_connection_header", None) or {})
        _handle_request(service, transport, request)

    return handle_request
