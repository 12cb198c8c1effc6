"""Many simultaneous connections to and from a node."""

import socket
import threading
from contextlib import ExitStack
from types import SimpleNamespace

import pytest
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_base import TCPServer

from rospy_transport.replacements import install, uninstall

# Below TCP's first retransmission after 1 s.
SECONDS = 0.5


@pytest.fixture(autouse=True)
def installed():
    install()
    yield
    uninstall()


@pytest.fixture
def server():
    server = TCPServer(lambda connection, address: None)
    yield server
    server.shutdown()


def test_connections_to_a_busy_node_need_no_tcp_retry(server):
    with ExitStack() as connections:
        for _ in range(60):
            address = ("127.0.0.1", server.port)
            connections.enter_context(socket.create_connection(address, timeout=SECONDS))


@pytest.fixture
def connect_after():
    """Returns the publishers that a node connects to after publisher updates from the master."""

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
