"""Connections of many at once, as when a graph starts."""

import socket
from typing import Sequence

from rospy.impl.registration import RegManager
from rospy.impl.tcpros_base import TCPServer

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
