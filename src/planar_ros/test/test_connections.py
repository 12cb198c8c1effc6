"""Many simultaneous connections to and from a node."""

import socket
import threading
from contextlib import ExitStack
from types import SimpleNamespace

import pytest
from rospy.impl import tcpros_base
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_base import TCPServer

from planar_ros.node.connections import extend_listen_backlog, merge_publisher_updates

# Below TCP's first retransmission after 1 s.
SECONDS = 0.5


@pytest.fixture
def server(monkeypatch):
    monkeypatch.setattr(tcpros_base.TCPServer, "_create_server_sock", TCPServer._create_server_sock)
    extend_listen_backlog()
    server = TCPServer(lambda connection, address: None)
    yield server
    server.shutdown()


def test_connections_to_a_busy_node_need_no_tcp_retry(server):
    with ExitStack() as connections:
        for _ in range(60):
            address = ("127.0.0.1", server.port)
            connections.enter_context(socket.create_connection(address, timeout=SECONDS))


@pytest.fixture
def connect_after(monkeypatch):
    """Returns the publishers that a node connects to after publisher updates from the master."""
    monkeypatch.setattr(RegManager, "publisher_update", RegManager.publisher_update)
    merge_publisher_updates()

    def connected(number, *updates):
        requested, enough = [], threading.Event()

        def connect(topic, uri):
            requested.append((topic, uri))
            if len(requested) == number:
                enough.set()
            return 1, "", 0

        handler = SimpleNamespace(done=False, _connect_topic=connect)
        registrations = RegManager(handler)
        for update in updates:
            registrations.publisher_update(*update)
        thread = threading.Thread(target=registrations.run)
        thread.start()
        enough.wait(SECONDS)
        handler.done = True
        thread.join()
        return sorted(requested)

    return connected


def test_an_outdated_empty_update_does_not_drop_a_new_publisher(connect_after):
    assert connect_after(1, ("/scan", ["http://one"]), ("/scan", [])) == [("/scan", "http://one")]


def test_each_publisher_is_connected_to_once(connect_after):
    updates = ("/scan", ["http://one"]), ("/tf", ["http://one"]), ("/scan", ["http://two", "http://one"])
    every = [("/scan", "http://one"), ("/scan", "http://two"), ("/tf", "http://one")]
    assert connect_after(3, *updates) == every
