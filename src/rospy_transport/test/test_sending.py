"""What publishers of rospy do with the connections of ``install``, and what rospy knows about them."""

import socket
import threading

import pytest
import rospy
from rospy.impl.tcpros_base import TCPROSTransport
from rospy.impl.tcpros_pubsub import QueuedConnection, TCPROSPub
from std_msgs.msg import String

from rospy_transport import connections
from rospy_transport.replacements import ImmediateConnection, install

TOPIC, NODE = "/topic", "/subscriber"
BACKLOG = 1 << 22  # more than a socket buffers [bytes]


@pytest.fixture
def connect(opened):
    """Connects a subscriber to a publisher; returns the publisher, the remote socket and the connection."""

    def made(install_first=True, **options):
        if install_first:
            install(connections=ImmediateConnection)
        publisher = opened(rospy.Publisher(TOPIC, String, **{"queue_size": 10, **options}))
        near, far = socket.socketpair()
        opened(far).settimeout(5.0)
        return publisher, far, connections.connect(publisher, NODE, near)

    return made


def is_sent_by_its_thread(connection):
    """Whether the thread of a connection has taken what it blocks on from the queue."""
    return not (connection._queue or getattr(connection, "_rest", b""))


def frame(text):
    return (len(text) + 4).to_bytes(4, "little") + len(text).to_bytes(4, "little") + text.encode()


def test_a_publisher_with_a_queue_uses_the_installed_class(connect):
    publisher, far, connection = connect()
    assert isinstance(connection, ImmediateConnection)
    assert (connection.receiver, connection.topic) == (NODE, TOPIC)
    publisher.publish("now")
    assert far.recv(100) == frame("now")
    assert list(connections.outgoing()) == [(NODE, TOPIC, connection)]
    assert connections.message_count(connection) == 1
    assert connections.topic_names() == ({TOPIC}, frozenset())


def test_a_publisher_without_a_queue_uses_a_plain_connection(connect):
    with pytest.warns(SyntaxWarning):
        publisher, far, connection = connect(queue_size=None)
    assert isinstance(connection, TCPROSTransport)
    publisher.publish("now")
    assert far.recv(100) == frame("now")
    assert connections.message_count(connection) == 1
    assert connections.full_queues(publisher) == 0
    assert not connections.OpenConnections(publisher).are_sending()


def test_a_node_that_connects_again_replaces_its_connection(connect, opened):
    publisher, _, first = connect()
    near, far = socket.socketpair()
    second = connections.connect(publisher, NODE, near)
    opened(far)
    assert first.is_broken and not second.is_broken
    assert [each for *_, each in connections.outgoing()] == [second]
    assert connections.is_connected(publisher, NODE)
    assert not connections.is_connected(publisher, "/another")


def test_a_closed_connection_is_removed(connect):
    publisher, _, connection = connect()
    connection.close()
    assert not connections.is_connected(publisher, NODE)
    assert publisher.get_num_connections() == 0


@pytest.mark.parametrize("is_immediate", (True, False))
def test_a_slow_subscriber_fills_its_queue_and_is_waited_for(connect, wait_until, is_immediate):
    publisher, far, connection = connect(is_immediate, queue_size=1)
    assert type(connection) is (ImmediateConnection if is_immediate else QueuedConnection)
    publisher.publish("x" * BACKLOG)
    wait_until(lambda: is_sent_by_its_thread(connection))
    publisher.publish("y")
    assert connections.full_queues(publisher) == 1
    open_connections = connections.OpenConnections(publisher)
    assert open_connections.are_sending()
    received = bytearray()
    while not received.endswith(frame("y")):
        received += far.recv(1 << 20)
    wait_until(lambda: not open_connections.are_sending())
    assert len(open_connections.sockets()) == 1


def test_an_unlimited_queue_is_never_full(connect, wait_until):
    publisher, _, connection = connect(queue_size=1)
    connection.keep_all()
    publisher.publish("x" * BACKLOG)
    wait_until(lambda: is_sent_by_its_thread(connection))
    for _ in range(3):
        publisher.publish("y")
    assert connections.full_queues(publisher) == 0
    assert len(connection._queue) == 3


def test_an_error_ends_the_connection_at_the_next_message(connect):
    publisher, _, connection = connect()
    connection.fail(OSError("broken"))
    assert connection.is_broken
    publisher.publish("lost")
    assert publisher.get_num_connections() == 0


def test_a_latched_message_is_sent_after_the_connection_was_added(opened):
    """So an open connection with a latched message and no sent one is about to send it."""
    open_connections, counts = [], []

    class Listener(rospy.SubscribeListener):
        def peer_subscribe(self, *_):
            counts.append(latching.get_num_connections())
            open_connections.append(connections.OpenConnections(latching))
            counts.append(open_connections[0].are_sending())

    install(connections=ImmediateConnection)
    latching = opened(rospy.Publisher(TOPIC, String, Listener(), latch=True, queue_size=10))
    latching.publish("latched")
    near, far = socket.socketpair()
    connections.connect(latching, NODE, near)
    assert opened(far).recv(100) == frame("latched")
    assert counts == [1, True]
    assert not open_connections[0].are_sending()


def test_a_listener_may_publish_while_another_thread_does(opened):
    """rospy gives a listener functions that take no lock; add_markers relies on a separate lock."""
    published = threading.Event()

    class Listener(rospy.SubscribeListener):
        def peer_subscribe(self, name, publish, publish_to_peer):
            publish_to_peer(String("welcome"))
            published.set()

    publisher = opened(rospy.Publisher(TOPIC, String, Listener(), queue_size=10))
    near, far = socket.socketpair()
    publisher.impl.acquire()
    try:
        threading.Thread(target=connections.connect, args=(publisher, NODE, near), daemon=True).start()
        assert published.wait(5.0)
    finally:
        publisher.impl.release()
    assert opened(far).recv(100) == frame("welcome")


def test_the_class_is_looked_up_when_a_subscriber_connects(connect, opened):
    publisher, _, plain = connect(install_first=False)
    assert type(plain) is QueuedConnection
    install(connections=ImmediateConnection)
    near, far = socket.socketpair()
    opened(far)
    assert isinstance(connections.connect(publisher, "/late", near), ImmediateConnection)


def test_a_protocol_names_its_topic():
    assert TCPROSPub(TOPIC, String).resolved_name == TOPIC
