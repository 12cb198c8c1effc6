"""Many connect to a node at once."""

import socket
from contextlib import ExitStack

import pytest
from rospy.impl import tcpros_base
from rospy.impl.tcpros_base import TCPServer

from planar_ros.node.backlog import let_many_wait

# TCP tries again after 1 s.
SECONDS = 0.5


@pytest.fixture
def server(monkeypatch):
    monkeypatch.setattr(tcpros_base.TCPServer, "_create_server_sock", TCPServer._create_server_sock)
    let_many_wait()
    server = TCPServer(lambda connection, address: None)
    yield server
    server.shutdown()


def test_who_connects_to_a_node_that_is_busy_need_not_try_again(server):
    with ExitStack() as connections:
        for _ in range(60):
            address = ("127.0.0.1", server.port)
            connections.enter_context(socket.create_connection(address, timeout=SECONDS))
