"""Publishing without a change of threads for every message and subscriber."""

import socket
from typing import List, Optional

import rospy.topics
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
