"""Messages are delivered at the logical instant for which they were counted."""

import threading
from io import BytesIO
from types import SimpleNamespace

import pytest
import rospy
from std_msgs.msg import String

from planar_ros.lockstep import message_buffer as module
from planar_ros.lockstep.message_buffer import MessageBuffer
from planar_ros.lockstep.transport import SerializedMessage

CHANNEL = ("/state", "/pick_objects")


@pytest.fixture
def received(monkeypatch):
    """The messages that subscribers' callbacks have received."""
    received = []
    monkeypatch.setattr(
        module, "_receive", lambda _to, messages, _by: received.extend(each.data for each in messages)
    )
    return received


@pytest.fixture
def buffer():
    buffer = MessageBuffer(True, lambda text: None)
    buffer.members = frozenset(("/pick_objects",))
    return buffer


def connection():
    return SimpleNamespace(
        callerid_pub="/pick_objects",
        is_latched=True,
        header={},
        latch=None,
        socket=object(),
        protocol=SimpleNamespace(recv_data_class=String),
    )


SUBSCRIBER = SimpleNamespace(resolved_name="/state", queue_size=None, callbacks=[(None, None)])


def receive(buffer, by, *words):
    for word in words:
        content = BytesIO()
        String(word).serialize(content)
        buffer._on_receive(SUBSCRIBER, [SerializedMessage(content.getvalue())], by)


def test_buffered_messages_are_delivered_when_released(buffer, received):
    receive(buffer, connection(), "going", "picking up")
    assert received == []
    assert buffer.release({CHANNEL: 1}) == []
    assert received == ["going"]
    assert buffer.release({CHANNEL: 2}) == []
    assert received == ["going", "picking up"]


def test_the_last_message_is_delivered_after_its_connection_was_reopened(buffer, received):
    """rospy of Debian 11 reopens a closed connection with the same object."""
    by = connection()
    receive(buffer, by, "going", "picking up")
    buffer.release({CHANNEL: 2})
    receive(buffer, by, "delivered")
    by.socket = object()
    receive(buffer, by, "delivered")  # which is latched
    buffer.release({CHANNEL: 1})  # counted from zero
    assert received == ["going", "picking up", "delivered", "delivered"]


def test_the_last_message_of_a_node_that_has_died_is_delivered(buffer, received):
    receive(buffer, connection(), "going")
    receive(buffer, connection(), "going again")
    buffer.release({CHANNEL: 1})
    assert received == ["going", "going again"]


def test_a_message_counts_as_received_only_after_its_callback_has_returned(buffer, monkeypatch):
    buffer.members = frozenset()
    has_begun, may_end, is_over = (threading.Event() for _ in range(3))

    def call_back(*_):
        has_begun.set()
        may_end.wait(10.0)
        is_over.set()

    monkeypatch.setattr(module, "_receive", call_back)
    monkeypatch.setitem(rospy.topics.get_topic_manager().subs, "/state", SUBSCRIBER)
    receiving = threading.Thread(target=receive, args=(buffer, connection(), "going"))
    receiving.start()
    assert has_begun.wait(10.0)
    buffer.members = frozenset(("/pick_objects",))
    threading.Timer(0.1, may_end.set).start()
    assert buffer.release({CHANNEL: 1}) == []
    assert is_over.is_set()
    receiving.join(10.0)
