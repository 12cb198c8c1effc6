"""Messages that a synchronized node sends before shutdown are counted and delivered."""

import threading
import time
from types import SimpleNamespace

import pytest

from planar_ros.lockstep import transport
from planar_ros.lockstep.transport import LockstepConnection
from planar_ros.node import flush, topics

SENDER, RECEIVER, TOPIC = "/pick_objects", "/add_markers", "/pick_objects/mission_state"
CHANNEL = f"{SENDER} {RECEIVER} {TOPIC}"


@pytest.fixture
def publisher(monkeypatch):
    """A publisher without connections yet, whose node is synchronized with the receiver."""
    found = SimpleNamespace(
        resolved_name=TOPIC,
        impl=SimpleNamespace(connections=[], latch=None),
        get_num_connections=lambda: len(found.impl.connections),
    )
    monkeypatch.setattr(
        transport, "connections", lambda: ((RECEIVER, TOPIC, each) for each in found.impl.connections)
    )
    monkeypatch.setattr(transport, "_last_counts", {})
    monkeypatch.setattr(topics, "count_subscribers", lambda topic: 1)
    monkeypatch.setattr(LockstepConnection, "members", frozenset((SENDER, RECEIVER)))
    return found


@pytest.fixture
def connect(publisher, connected):
    """Connects the receiver; returns its socket and the connection to write to."""

    def connect():
        far, connection = connected(RECEIVER, TOPIC)
        publisher.impl.connections.append(connection)
        return far, connection

    return connect


def close_after_reading(far, publisher):
    """Do as rospy: a subscriber closes after its publisher, and the connection is removed."""

    def read():
        while far.recv(1024):
            pass
        publisher.impl.connections.clear()
        far.close()

    reading = threading.Thread(target=read)
    reading.start()
    return reading


def test_messages_sent_on_shutdown_are_counted_after_their_connection_is_removed(publisher, connect):
    far, connection = connect()
    connection.write_data(b"setting down")
    assert transport.sent(SENDER) == {CHANNEL: 1}
    connection.write_data(b"delivered")
    reading = close_after_reading(far, publisher)
    flush.flush_and_close(publisher)
    reading.join(5.0)
    assert publisher.impl.connections == []
    assert transport.sent(SENDER) == {CHANNEL: 2}


def test_a_new_connection_starts_at_zero_messages(publisher, connect):
    far, connection = connect()
    connection.write_data(b"delivered")
    reading = close_after_reading(far, publisher)
    flush.flush_and_close(publisher)
    reading.join(5.0)
    connect()
    assert transport.sent(SENDER) == {CHANNEL: 0}
    publisher.impl.connections.clear()
    assert transport.sent(SENDER) == {}


def test_a_subscriber_that_disconnects_is_not_waited_for(publisher, monkeypatch):
    counts = iter((1, 1))
    monkeypatch.setattr(topics, "count_subscribers", lambda topic: next(counts, 0))
    started = time.monotonic()
    flush.flush_and_close(publisher)
    assert time.monotonic() - started < flush.PATIENCE_SECONDS / 2


@pytest.mark.parametrize("is_synchronized", (True, False))
def test_a_latched_message_reaches_a_new_subscriber(publisher, connect, monkeypatch, is_synchronized):
    if not is_synchronized:
        monkeypatch.setattr(LockstepConnection, "members", frozenset())
    far, connection = connect()
    publisher.impl.latch = b"latched"
    sending = threading.Timer(0.1, lambda: connection.write_data(publisher.impl.latch))
    sending.start()
    received = []
    reading = threading.Thread(target=lambda: received.extend(iter(lambda: far.recv(1024), b"")))
    reading.start()
    flush.flush_and_close(publisher, patience=1.0)
    reading.join(10.0)
    assert b"".join(received) == b"latched"
