"""Publishers, subscribers and services of this process that are connected without a master."""

import socket
import time

import pytest
import rospy
from rospy.impl import tcpros_base
from rospy.impl.tcpros import get_tcpros_handler, init_tcpros
from rospy.impl.tcpros_base import get_tcpros_server_address, start_tcpros_server

from rospy_transport.node import unregistered_node
from rospy_transport.replacements import uninstall

DEADLINE = 10.0


@pytest.fixture(scope="session")
def address():
    """Address and port of rospy's server for connections to topics and services."""
    tcpros_base._use_tcp_keepalive = False  # otherwise read from the master
    init_tcpros()
    start_tcpros_server()
    return get_tcpros_server_address()


@pytest.fixture(autouse=True)
def node():
    """This process is a node without a master; afterwards rospy is as it was."""
    with unregistered_node():
        yield
    uninstall()


@pytest.fixture
def opened():
    """Registers what the test opens: topics, whose threads Python would wait for at exit, and sockets."""
    found = []
    yield lambda each: found.append(each) or each
    for each in found:
        each.close() if isinstance(each, socket.socket) else each.unregister()


@pytest.fixture
def subscribe(address, opened):
    """Subscribes to a topic of this process, as rospy does when the master names its publisher."""

    def made(topic, kind, callback, **options):
        subscriber = opened(rospy.Subscriber(topic, kind, callback, **options))
        code, text, _ = get_tcpros_handler().create_transport(
            subscriber.resolved_name, "http://publisher", ["TCPROS", *address]
        )
        assert code == 1, text
        return subscriber

    return made


@pytest.fixture
def wait_until():
    def waited(holds):
        end = time.monotonic() + DEADLINE
        while not holds():
            assert time.monotonic() < end, "nothing happened"
            time.sleep(0.005)

    return waited
