"""Patches of rospy's connections: immediate sending, a longer listen backlog, no lost publisher updates."""

import socket
from typing import List, Optional, Sequence

import rospy.topics
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_base import TCPServer
from rospy.impl.tcpros_pubsub import QueuedConnection


def send_immediately() -> None:
    """Make publishers with a queue send at once what the socket accepts; call it once per process.

    rospy passes every message to a thread of each subscriber, which costs a node with many messages more than
    all its other work. A slow subscriber still blocks nothing: its thread takes over.
    """
    rospy.topics.QueuedConnection = ImmediateConnection


class ImmediateConnection(QueuedConnection):
    """Connection that sends directly; its thread sends only what does not fit into the socket's buffer."""

    def __init__(self, connection, queue_size: int):
        # Rest of a message that was sent partially; unlike queued messages it must not be dropped.
        self._rest = b""
        self._is_relaying = False
        self._queue: List[bytes]
        self._error: Optional[Exception]
        super().__init__(connection, queue_size)

    def write_data(self, data) -> bool:
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
        return super().write_data(data)

    def _send(self, data) -> int:
        """Return how many bytes the socket accepted without blocking; errors are left to the thread."""
        try:
            sent = self._connection.socket.send(data, socket.MSG_DONTWAIT)
        except (OSError, AttributeError):
            return 0
        self._connection.stat_bytes += sent
        self._connection.stat_num_msg += 1
        return sent

    def _run(self):
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


LISTEN_BACKLOG = 128


def extend_listen_backlog() -> None:
    """Make the node's server accept many simultaneous connections; call it before ``init_node``.

    rospy's backlog is five; a sixth connection is retried by TCP only after a second.
    """

    def create(self: TCPServer) -> socket.socket:
        server: socket.socket = _create(self)
        server.listen(LISTEN_BACKLOG)
        return server

    TCPServer._create_server_sock = create


def merge_publisher_updates() -> None:
    """Make the node connect to all publishers of queued updates; call it before ``init_node``.

    rospy uses the newest list of publishers of a topic. If a publisher registers while the node subscribes,
    the master's update may arrive before the older answer to the subscription, and the node would never
    connect.
    """

    def update(self: RegManager, topic: str, uris: Sequence[str]) -> None:
        with self.cond:
            queued = [uri for name, earlier in self.updates if name == topic for uri in earlier]
            _update(self, topic, list(dict.fromkeys((*queued, *uris))))

    RegManager.publisher_update = update


_create, _update = TCPServer._create_server_sock, RegManager.publisher_update
