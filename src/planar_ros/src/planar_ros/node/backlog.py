"""Connections of many at once, as when a graph starts."""

import socket

from rospy.impl.tcpros_base import TCPServer

WAITING = 128


def let_many_wait() -> None:
    """From now on the node's server keeps so many connections waiting; to be called before ``init_node``.

    rospy's keeps five, and the sixth comes a second later: TCP tries again after that time.
    """

    def create(self: TCPServer) -> socket.socket:
        server: socket.socket = _create(self)
        server.listen(WAITING)
        return server

    TCPServer._create_server_sock = create


_create = TCPServer._create_server_sock
