"""Messages that a synchronized node sends before shutdown are counted and delivered."""

import socket
import threading
import time

import pytest
import rosgraph
import rospy
from std_msgs.msg import String

from planar_ros.lockstep import transport
from planar_ros.lockstep.transport import LockstepConnection
from planar_ros.node import topics
from rospy_transport.connections import connect as connect_to
from rospy_transport.node import unregistered_node

SENDER, RECEIVER, TOPIC = "/pick_objects", "/add_markers", "/pick_objects/mission_state"
CHANNEL = f"{SENDER} {RECEIVER} {TOPIC}"


@pytest.fixture(autouse=True)
def synchronized(monkeypatch):
    """The node is synchronized with the receiver."""
    monkeypatch.setattr(transport, "_last_counts", {})
    monkeypatch.setattr(topics, "unconnected_subscribers", lambda publisher: [])
    monkeypatch.setattr(LockstepConnection, "members", frozenset((SENDER, RECEIVER)))


def close_after_reading(far, connection):
    """Do as rospy: a subscriber closes after its publisher, and the connection is removed."""

    def read():
        while far.recv(1024):
            pass
        connection.close()
        far.close()

    reading = threading.Thread(target=read)
    reading.start()
    return reading


def test_a_connection_to_itself_does_not_count_for_another_subscriber(publisher, connected, monkeypatch):
    """rospy counts both; a point clicked in the cockpit, which shows it as well, was lost by the other."""

    nodes = [rospy.get_name(), RECEIVER, "/killed"]
    monkeypatch.undo()
    monkeypatch.setattr(rosgraph.Master, "getSystemState", lambda _: ([], [[TOPIC, nodes]], []))
    monkeypatch.setattr(topics, "_is_running", lambda _, node: node != "/killed")
    connected(rospy.get_name(), TOPIC)
    assert topics.unconnected_subscribers(publisher(TOPIC)) == [RECEIVER]
    assert not topics.has_all_subscribers(publisher(TOPIC))
    connected(RECEIVER, TOPIC)
    assert topics.has_all_subscribers(publisher(TOPIC))


def test_messages_sent_on_shutdown_are_counted_after_their_connection_is_removed(publisher, connected):
    far, connection = connected(RECEIVER, TOPIC)
    connection.write_data(b"setting down")
    assert transport.sent(SENDER) == {CHANNEL: 1}
    connection.write_data(b"delivered")
    reading = close_after_reading(far, connection)
    topics.flush_and_close(publisher(TOPIC))
    reading.join(5.0)
    assert publisher(TOPIC).get_num_connections() == 0
    assert transport.sent(SENDER) == {CHANNEL: 2}


def test_a_new_connection_starts_at_zero_messages(publisher, connected):
    far, connection = connected(RECEIVER, TOPIC)
    connection.write_data(b"delivered")
    reading = close_after_reading(far, connection)
    topics.flush_and_close(publisher(TOPIC))
    reading.join(5.0)
    _, connection = connected(RECEIVER, TOPIC)
    assert transport.sent(SENDER) == {CHANNEL: 0}
    connection.close()
    assert transport.sent(SENDER) == {}


def test_a_subscriber_that_disconnects_is_not_waited_for(publisher, monkeypatch):
    answers = iter(([RECEIVER], [RECEIVER]))
    monkeypatch.setattr(topics, "unconnected_subscribers", lambda publisher: next(answers, []))
    started = time.monotonic()
    topics.flush_and_close(publisher(TOPIC))
    assert time.monotonic() - started < topics.PATIENCE_SECONDS / 2


@pytest.mark.parametrize("is_synchronized", (True, False))
def test_a_latched_message_reaches_a_new_subscriber(publisher, monkeypatch, is_synchronized):
    """rospy adds a connection, then sends the latched message; here a listener of the topic delays it."""
    if not is_synchronized:
        monkeypatch.setattr(LockstepConnection, "members", frozenset())
    has_connected = threading.Event()

    class Delay(rospy.SubscribeListener):
        def peer_subscribe(self, *_):
            has_connected.set()
            time.sleep(0.1)

    latching = rospy.Publisher(TOPIC, String, Delay(), latch=True, queue_size=50)
    with unregistered_node():
        latching.publish("latched")
    near, far = socket.socketpair()
    connecting = threading.Thread(target=connect_to, args=(publisher(TOPIC), RECEIVER, near))
    connecting.start()
    assert has_connected.wait(5.0)
    received = []
    reading = threading.Thread(target=lambda: received.extend(iter(lambda: far.recv(1024), b"")))
    reading.start()
    topics.flush_and_close(latching, patience=1.0)
    connecting.join(10.0)
    reading.join(10.0)
    latching.unregister()
    far.close()
    assert b"".join(received).endswith(b"latched")
