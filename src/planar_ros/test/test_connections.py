"""Many connect to a node at once, and it to many."""

import socket
import threading
from contextlib import ExitStack
from types import SimpleNamespace

import pytest
from rospy.impl import tcpros_base
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_base import TCPServer

from planar_ros.node.connections import extend_listen_backlog, merge_publisher_updates

# TCP tries again after 1 s.
SECONDS = 0.5


@pytest.fixture
def server(monkeypatch):
    monkeypatch.setattr(tcpros_base.TCPServer, "_create_server_sock", TCPServer._create_server_sock)
    extend_listen_backlog()
    server = TCPServer(lambda connection, address: None)
    yield server
    server.shutdown()


def test_who_connects_to_a_node_that_is_busy_need_not_try_again(server):
    with ExitStack() as connections:
        for _ in range(60):
            address = ("127.0.0.1", server.port)
            connections.enter_context(socket.create_connection(address, timeout=SECONDS))


@pytest.fixture
def told(monkeypatch):
    """The publishers that a node connects to, as it is told of ``updates``."""
    monkeypatch.setattr(RegManager, "publisher_update", RegManager.publisher_update)
    merge_publisher_updates()

    def connected(number, *updates):
        asked, enough = [], threading.Event()

        def connect(topic, uri):
            asked.append((topic, uri))
            if len(asked) == number:
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
        return sorted(asked)

    return connected


def test_the_news_of_a_publisher_outlives_an_answer_from_before(told):
    assert told(1, ("/scan", ["http://one"]), ("/scan", [])) == [("/scan", "http://one")]


def test_each_publisher_is_connected_to_once(told):
    updates = ("/scan", ["http://one"]), ("/tf", ["http://one"]), ("/scan", ["http://two", "http://one"])
    every = [("/scan", "http://one"), ("/scan", "http://two"), ("/tf", "http://one")]
    assert told(3, *updates) == every
