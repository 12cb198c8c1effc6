"""Publishing without a change of threads for every message and subscriber."""

import socket
from typing import List, Optional, Sequence

import rospy.topics
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_base import TCPServer
from rospy.impl.tcpros_pubsub import QueuedConnection


def send_immediately() -> None:
    """From now on publishers with a queue send at once what the socket takes; to be called once a node.

    rospy hands every message to a thread of each subscriber, which for a node that publishes much costs more
    than all its work. A subscriber that is slow still holds up nobody: then its thread takes over.
    """
    rospy.topics.QueuedConnection = ImmediateConnection


class ImmediateConnection(QueuedConnection):
    """Relays to a transport; its thread gets only what does not fit into the socket's buffer."""

    def __init__(self, connection, queue_size: int):
        # What is left of a message that was sent in part; unlike the queue's it must not be dropped.
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
        """How much of it the socket has taken without waiting; an error is left to the thread to meet."""
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


WAITING = 128


def extend_listen_backlog() -> None:
    """From now on the node's server keeps so many connections waiting; to be called before ``init_node``.

    rospy's keeps five, and the sixth comes a second later: TCP tries again after that time.
    """

    def create(self: TCPServer) -> socket.socket:
        server: socket.socket = _create(self)
        server.listen(WAITING)
        return server

    TCPServer._create_server_sock = create


def merge_publisher_updates() -> None:
    """From now on the node connects to all publishers that it is told of; to be called before ``init_node``.

    rospy's goes by the newest list of a topic's, as it comes. Who subscribes while another registers as its
    publisher may hear the master's news first, and then the answer, from before: it would never connect.
    """

    def update(self: RegManager, topic: str, uris: Sequence[str]) -> None:
        with self.cond:
            waiting = [uri for name, earlier in self.updates if name == topic for uri in earlier]
            _update(self, topic, list(dict.fromkeys((*waiting, *uris))))

    RegManager.publisher_update = update


_create, _update = TCPServer._create_server_sock, RegManager.publisher_update
