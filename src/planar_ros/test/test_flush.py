"""What a node in step has sent before all hang up is told with the moment's answer."""

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
    """A topic without anybody who listens to it yet; its node is in step with the receiver."""
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
    """Connects the receiver; returns its end, and what is then written to."""

    def connect():
        far, connection = connected(RECEIVER, TOPIC)
        publisher.impl.connections.append(connection)
        return far, connection

    return connect


def hang_up_after_reading(far, publisher):
    """As rospy does it: a node whose publisher says no more hangs up, and its connection is removed."""

    def read():
        while far.recv(1024):
            pass
        publisher.impl.connections.clear()
        far.close()

    reading = threading.Thread(target=read)
    reading.start()
    return reading


def test_last_words_are_counted_though_their_connection_has_been_removed(publisher, connect):
    far, connection = connect()
    connection.write_data(b"setting down")
    assert transport.sent(SENDER) == {CHANNEL: 1}
    connection.write_data(b"delivered")
    reading = hang_up_after_reading(far, publisher)
    flush.flush_and_close(publisher)
    reading.join(5.0)
    assert publisher.impl.connections == []
    assert transport.sent(SENDER) == {CHANNEL: 2}


def test_who_connects_anew_has_had_nothing(publisher, connect):
    far, connection = connect()
    connection.write_data(b"delivered")
    reading = hang_up_after_reading(far, publisher)
    flush.flush_and_close(publisher)
    reading.join(5.0)
    connect()
    assert transport.sent(SENDER) == {CHANNEL: 0}
    publisher.impl.connections.clear()
    assert transport.sent(SENDER) == {}


def test_who_leaves_meanwhile_is_not_waited_for(publisher, monkeypatch):
    counts = iter((1, 1))
    monkeypatch.setattr(topics, "count_subscribers", lambda topic: next(counts, 0))
    started = time.monotonic()
    flush.flush_and_close(publisher)
    assert time.monotonic() - started < flush.PATIENCE_SECONDS / 2


@pytest.mark.parametrize("is_in_step", (True, False))
def test_a_latched_word_is_heard_by_who_has_come_just_now(publisher, connect, monkeypatch, is_in_step):
    if not is_in_step:
        monkeypatch.setattr(LockstepConnection, "members", frozenset())
    far, connection = connect()
    publisher.impl.latch = b"latched"
    rospy_sends_it = threading.Timer(0.1, lambda: connection.write_data(publisher.impl.latch))
    rospy_sends_it.start()
    heard = []
    reading = threading.Thread(target=lambda: heard.extend(iter(lambda: far.recv(1024), b"")))
    reading.start()
    flush.flush_and_close(publisher, patience=1.0)
    reading.join(10.0)
    assert b"".join(heard) == b"latched"
