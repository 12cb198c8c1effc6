"""What is told to those who look on comes in one piece, in order, and a peer that has gone harms nobody."""

import socket
import threading
import time

import pytest

from planar_ros.lockstep import transport
from planar_ros.lockstep.transport import CLOCK_TOPIC, MAX_BATCH, LockstepConnection

REFEREE, TOPIC = "/referee", "/base_pose_ground_truth"
BROKEN_SECONDS = 5.0


@pytest.fixture
def connect(monkeypatch, connected):
    """Connects a node to a topic, by default one that looks on; this thread saves its sends."""
    monkeypatch.setattr(LockstepConnection, "members", frozenset(("/sim_bridge", "/amcl")))
    monkeypatch.setattr(LockstepConnection, "observers", frozenset((REFEREE,)))
    monkeypatch.setattr(LockstepConnection, "batching_thread", threading.get_ident())

    def connect(node=REFEREE, topic=TOPIC):
        far, connection = connected(node, topic)
        far.settimeout(0.1)
        return far, connection

    yield connect
    transport.flush()


def heard(end):
    try:
        return end.recv(1024)
    except socket.timeout:
        return b""


@pytest.mark.parametrize("node, topic", [(REFEREE, TOPIC), (REFEREE, CLOCK_TOPIC), ("/rviz", CLOCK_TOPIC)])
def test_messages_are_kept_back_until_they_are_flushed(connect, node, topic):
    far, connection = connect(node, topic)
    for word in (b"one ", b"two ", b"three"):
        connection.write_data(word)
    assert heard(far) == b""
    transport.flush()
    assert heard(far) == b"one two three"


def test_who_does_not_look_on_hears_at_once(connect):
    far, connection = connect("/rviz")
    connection.write_data(b"now")
    assert heard(far) == b"now"


def test_another_thread_sends_at_once_and_in_order(connect):
    far, connection = connect()
    connection.write_data(b"first ")
    thread = threading.Thread(target=connection.write_data, args=(b"second",))
    thread.start()
    thread.join()
    assert heard(far) in (b"first ", b"first second")
    assert connection.count == 2


def test_no_more_than_so_many_wait_though_nobody_flushes(connect):
    far, connection = connect()
    for _ in range(MAX_BATCH + 1):
        connection.write_data(b".")
    assert len(heard(far)) >= MAX_BATCH


def test_a_peer_that_has_gone_is_left_to_the_next_message(connect):
    """rospy removes a connection whose message meets an error; who flushes has none to remove."""
    far, connection = connect()
    far.close()
    end, errors = time.monotonic() + BROKEN_SECONDS, []
    while not errors and time.monotonic() < end:
        try:
            connection.write_data(b"lost")
        except OSError as error:
            errors.append(error)
        transport.flush()
        time.sleep(0.01)
    assert errors
