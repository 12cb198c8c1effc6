"""Messages to observers are batched, in order, and a closed connection affects no other."""

import socket
import threading
import time

import pytest
import rospy

from planar_ros.lockstep import transport
from planar_ros.lockstep.transport import CLOCK_TOPIC, MAX_BATCH, LockstepConnection

REFEREE, TOPIC = "/referee", "/base_pose_ground_truth"
BROKEN_SECONDS = 5.0


@pytest.fixture
def connect(monkeypatch, connected):
    """Connects a node to a topic, by default an observer; this thread batches its sends."""
    monkeypatch.setattr(LockstepConnection, "members", frozenset(("/sim_bridge", "/amcl")))
    monkeypatch.setattr(LockstepConnection, "observers", frozenset((REFEREE,)))
    monkeypatch.setattr(LockstepConnection, "batching_thread", threading.get_ident())

    def connect(node=REFEREE, topic=TOPIC):
        far, connection = connected(node, topic)
        far.settimeout(0.1)
        return far, connection

    yield connect
    transport.flush()


def received(end):
    try:
        return end.recv(1024)
    except socket.timeout:
        return b""


@pytest.mark.parametrize("node, topic", [(REFEREE, TOPIC), (REFEREE, CLOCK_TOPIC), ("/rviz", CLOCK_TOPIC)])
def test_messages_to_observers_are_batched_until_flushed(connect, node, topic):
    far, connection = connect(node, topic)
    for word in (b"one ", b"two ", b"three"):
        connection.write_data(word)
    assert received(far) == b""
    transport.flush()
    assert received(far) == b"one two three"


def test_a_node_that_is_no_observer_receives_at_once(connect):
    far, connection = connect("/rviz")
    connection.write_data(b"now")
    assert received(far) == b"now"


def test_another_thread_sends_at_once_and_in_order(connect):
    far, connection = connect()
    connection.write_data(b"first ")
    thread = threading.Thread(target=connection.write_data, args=(b"second",))
    thread.start()
    thread.join()
    assert received(far) in (b"first ", b"first second")
    assert connection.count == 2


def test_a_batch_is_bounded_without_a_flush(connect):
    far, connection = connect()
    for _ in range(MAX_BATCH + 1):
        connection.write_data(b".")
    assert len(received(far)) >= MAX_BATCH


def test_a_closed_connection_raises_at_the_next_message_and_not_at_the_flush(connect):
    """rospy removes a connection when writing a message raises; flush() has no message to attribute it to."""
    far, connection = connect()
    far.close()
    end, errors = time.monotonic() + BROKEN_SECONDS, []
    while not errors and time.monotonic() < end:
        try:
            connection.write_data(b"lost")
        except rospy.TransportTerminated as error:
            errors.append(error)
        transport.flush()
        time.sleep(0.01)
    assert errors
