"""Messages are delivered at the logical instant for which they were counted."""

import threading

import pytest

from planar_ros.lockstep import message_buffer as module
from planar_ros.lockstep.message_buffer import MessageBuffer
from rospy_transport.replacements import SerializedMessage

CHANNEL = ("/state", "/pick_objects")


class Connection:
    """A connection of this node's subscriber, whose messages are appended to a list."""

    topic, sender = CHANNEL
    is_latched = True

    def __init__(self, received):
        self._received = received

    def deliver(self, frames):
        self._received.extend(frame.data for frame in frames)


@pytest.fixture
def received():
    """The messages that subscribers' callbacks have received."""
    return []


@pytest.fixture
def buffer():
    buffer = MessageBuffer(True, lambda text: None)
    buffer.members = frozenset(("/pick_objects",))
    return buffer


def receive(buffer, by, *words):
    for word in words:
        buffer.receive(by, [SerializedMessage(word)])


def test_buffered_messages_are_delivered_when_released(buffer, received):
    receive(buffer, Connection(received), "going", "picking up")
    assert received == []
    assert buffer.release({CHANNEL: 1}) == []
    assert received == ["going"]
    assert buffer.release({CHANNEL: 2}) == []
    assert received == ["going", "picking up"]


def test_the_last_message_is_delivered_after_its_connection_was_reopened(buffer, received):
    by = Connection(received)
    receive(buffer, by, "going", "picking up")
    buffer.release({CHANNEL: 2})
    receive(buffer, by, "delivered")
    receive(buffer, Connection(received), "delivered")  # which is latched
    buffer.release({CHANNEL: 1})  # counted from zero
    assert received == ["going", "picking up", "delivered", "delivered"]


def test_the_last_message_of_a_node_that_has_died_is_delivered(buffer, received):
    receive(buffer, Connection(received), "going")
    receive(buffer, Connection(received), "going again")
    buffer.release({CHANNEL: 1})
    assert received == ["going", "going again"]


def test_a_message_counts_as_received_only_after_its_callback_has_returned(buffer, monkeypatch):
    buffer.members = frozenset()
    has_begun, may_end, is_over = (threading.Event() for _ in range(3))

    def call_back(*_):
        has_begun.set()
        may_end.wait(10.0)
        is_over.set()

    connection = Connection([])
    connection.deliver = call_back
    monkeypatch.setattr(module, "is_subscribed", lambda topic: True)
    receiving = threading.Thread(target=receive, args=(buffer, connection, "going"))
    receiving.start()
    assert has_begun.wait(10.0)
    buffer.members = frozenset(("/pick_objects",))
    threading.Timer(0.1, may_end.set).start()
    assert buffer.release({CHANNEL: 1}) == []
    assert is_over.is_set()
    receiving.join(10.0)
