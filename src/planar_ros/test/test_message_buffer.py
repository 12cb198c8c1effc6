"""Messages that wait for their moment."""

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
def heard(monkeypatch):
    """What the callbacks of subscribers have been given."""
    heard = []
    monkeypatch.setattr(
        module, "_receive", lambda _to, messages, _by: heard.extend(each.data for each in messages)
    )
    return heard


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


def take(buffer, by, *words):
    for word in words:
        content = BytesIO()
        String(word).serialize(content)
        buffer._take(SUBSCRIBER, [SerializedMessage(content.getvalue())], by)


def test_what_waits_is_handed_on_when_its_moment_has_come(buffer, heard):
    take(buffer, connection(), "going", "picking up")
    assert heard == []
    assert buffer.release({CHANNEL: 1}) == []
    assert heard == ["going"]
    assert buffer.release({CHANNEL: 2}) == []
    assert heard == ["going", "picking up"]


def test_the_last_word_is_heard_though_its_connection_has_been_made_anew(buffer, heard):
    """rospy of Debian 11 connects again, by the same object, to who has closed a connection."""
    by = connection()
    take(buffer, by, "going", "picking up")
    buffer.release({CHANNEL: 2})
    take(buffer, by, "delivered")
    by.socket = object()
    take(buffer, by, "delivered")  # which is latched
    buffer.release({CHANNEL: 1})  # counted anew
    assert heard == ["going", "picking up", "delivered", "delivered"]


def test_the_last_word_of_a_node_that_has_died_is_heard(buffer, heard):
    take(buffer, connection(), "going")
    take(buffer, connection(), "going again")
    buffer.release({CHANNEL: 1})
    assert heard == ["going", "going again"]


def test_what_is_handed_on_just_now_has_not_come_before_its_callback_is_over(buffer, monkeypatch):
    buffer.members = frozenset()
    has_begun, may_end, is_over = (threading.Event() for _ in range(3))

    def call_back(*_):
        has_begun.set()
        may_end.wait(10.0)
        is_over.set()

    monkeypatch.setattr(module, "_receive", call_back)
    monkeypatch.setitem(rospy.topics.get_topic_manager().subs, "/state", SUBSCRIBER)
    taking = threading.Thread(target=take, args=(buffer, connection(), "going"))
    taking.start()
    assert has_begun.wait(10.0)
    buffer.members = frozenset(("/pick_objects",))
    threading.Timer(0.1, may_end.set).start()
    assert buffer.release({CHANNEL: 1}) == []
    assert is_over.is_set()
    taking.join(10.0)
