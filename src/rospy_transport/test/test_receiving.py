"""What subscribers and services of rospy do with the functions of ``install``."""

import socket
import threading
import time
from types import SimpleNamespace

import pytest
import rospy
from rospy.impl.tcpros_base import TCPROSTransport
from rospy.impl.tcpros_pubsub import TCPROSSub
from std_msgs.msg import String
from std_srvs.srv import SetBool, SetBoolResponse

from rospy_transport import connections
from rospy_transport.replacements import ImmediateConnection, IncomingConnection, install

TOPIC = "/topic"


@pytest.fixture
def publish(opened):
    """Returns a publisher of the topic."""
    return lambda **options: opened(rospy.Publisher(TOPIC, String, queue_size=10, **options))


@pytest.fixture
def held():
    """Holds received messages: pairs of the connection and its messages."""
    found = []

    def hold(connection, frames):
        found.extend((connection, frame) for frame in frames)

    install(ImmediateConnection, hold)
    return found


def test_messages_are_delivered_when_the_receiver_does_it(publish, subscribe, wait_until, held):
    publisher, received = publish(), []
    subscriber = subscribe(TOPIC, String, received.append)
    wait_until(lambda: publisher.get_num_connections() == 1)
    for word in ("one", "two"):
        publisher.publish(word)
    wait_until(lambda: len(held) == 2)
    assert received == []
    connection = held[0][0]
    assert connection is held[1][0]
    assert (connection.topic, connection.sender) == (TOPIC, rospy.get_name())
    assert not connection.is_latched
    assert connections.connected_publishers(subscriber) == {rospy.get_name()}
    assert connections.is_subscribed(TOPIC) and not connections.is_subscribed("/another")
    connection.deliver([frame for _, frame in held])
    assert [message.data for message in received] == ["one", "two"]
    assert received[0]._connection_header["callerid"] == rospy.get_name()


def test_only_the_latest_messages_are_delivered_to_a_short_queue(publish, subscribe, wait_until, held):
    publisher, received = publish(), []
    subscribe(TOPIC, String, received.append, queue_size=2)
    wait_until(lambda: publisher.get_num_connections() == 1)
    for number in range(5):
        publisher.publish(str(number))
    wait_until(lambda: len(held) == 5)
    held[0][0].deliver([frame for _, frame in held])
    assert [message.data for message in received] == ["3", "4"]


def test_a_latched_message_is_repeated_for_a_later_callback(publish, subscribe, opened, wait_until, held):
    publisher, later = publish(latch=True), []
    publisher.publish("latched")
    subscribe(TOPIC, String, lambda message: None)
    wait_until(lambda: held)
    connection, frame = held[0]
    assert connection.is_latched
    opened(rospy.Subscriber(TOPIC, String, later.append))
    assert later == [], "it was not delivered yet"
    connection.deliver([frame])
    opened(rospy.Subscriber(TOPIC, String, later.append))
    assert [message.data for message in later] == ["latched", "latched"]


def test_a_message_that_cannot_be_deserialized_keeps_no_other_back(publish, subscribe, wait_until, held):
    publisher, received = publish(), []
    subscribe(TOPIC, String, received.append)
    wait_until(lambda: publisher.get_num_connections() == 1)
    for word in ("one", "two"):
        publisher.publish(word)
    wait_until(lambda: len(held) == 2)
    held[0][1].data = b"\xff"
    held[0][0].deliver([frame for _, frame in held])
    assert [message.data for message in received] == ["two"]


def test_a_connection_that_was_made_before_calls_back_at_once(publish, subscribe, wait_until):
    publisher, received, held = publish(), [], []
    subscriber = subscribe(TOPIC, String, received.append)
    wait_until(lambda: connections.connected_publishers(subscriber) == {rospy.get_name()})
    install(receive=lambda connection, frames: held.extend(frames))
    wait_until(lambda: publisher.get_num_connections() == 1)
    publisher.publish("now")
    wait_until(lambda: received)
    assert held == []


def test_the_sender_is_unknown_before_the_handshake(opened):
    subscriber = opened(rospy.Subscriber(TOPIC, String, lambda message: None))
    assert connections.connected_publishers(subscriber) == set()


def test_a_connection_that_rospy_opens_again_is_another_one(address, publish, opened):
    """rospy of Debian 11 reconnects with the same object; the messages are counted from zero then."""
    publish()
    subscriber = opened(rospy.Subscriber(TOPIC, String, lambda message: None))
    own = TCPROSTransport(TCPROSSub(TOPIC, String), TOPIC)
    own.connect(*address, "http://publisher")
    before = IncomingConnection.of(subscriber.impl, own)
    assert (before.topic, before.sender) == (TOPIC, rospy.get_name())
    assert IncomingConnection.of(subscriber.impl, own) is before
    own.socket.close()
    own.socket = None
    own.connect(*own.dest_address, own.endpoint_id)
    assert IncomingConnection.of(subscriber.impl, own) is not before
    own.close()


def test_a_partial_message_is_received_when_it_is_complete(subscribe, wait_until, held, publish):
    publisher = publish()
    subscribe(TOPIC, String, lambda message: None)
    wait_until(lambda: publisher.get_num_connections() == 1)
    ((_, _, connection),) = connections.outgoing()
    connection.socket.sendall(b"\x09\x00\x00\x00\x05\x00")
    time.sleep(0.05)
    assert held == []
    connection.socket.sendall(b"\x00\x00whole")
    wait_until(lambda: held)
    assert held[0][1].data == b"\x05\x00\x00\x00whole"


def test_a_service_call_is_preceded_by_the_installed_function(address, monkeypatch):
    seen = []

    def before_call(service, header):
        seen.append((service, header["callerid"], header.get("moment"), threading.get_ident()))

    def answer(request):
        seen.append(threading.get_ident())
        return SetBoolResponse(request.data, "")

    install(before_call=before_call)
    service = rospy.Service("switch", SetBool, answer)
    proxy = rospy.ServiceProxy("switch", SetBool, headers={"moment": "7"})
    monkeypatch.setattr(proxy, "_get_service_uri", lambda request: service.uri)
    assert proxy(True).success
    (*call, thread), handler_thread = seen
    assert call == ["/switch", rospy.get_name(), "7"]
    assert thread == handler_thread != threading.get_ident()
    service.shutdown()


def test_a_message_is_unprocessed_until_its_callback_returns(publish, subscribe, wait_until):
    install(notes_receipt=True)
    publisher, begun, may_end = publish(), threading.Event(), threading.Event()

    def process(message):
        begun.set()
        may_end.wait(5.0)

    subscribe(TOPIC, String, process)
    wait_until(lambda: publisher.get_num_connections() == 1)
    wait_until(lambda: not connections.has_unprocessed())
    publisher.publish("one")
    wait_until(connections.has_unprocessed)

    def has_begun():
        is_begun = begun.is_set()
        assert is_begun or connections.has_unprocessed(), "it is in the socket, or read"
        return is_begun

    wait_until(has_begun)
    assert connections.has_unprocessed(), "its callback has not returned"
    may_end.set()
    wait_until(lambda: not connections.has_unprocessed())


def test_a_message_that_is_read_during_the_look_is_unprocessed(monkeypatch):
    """A thread may take it from the socket after the look at its connection, before that at the socket."""
    near, far = socket.socketpair()
    far.sendall(b"one")

    class Reading:
        """A connection whose thread reads the message as soon as another has looked whether it does."""

        socket = near
        was_seen = False

        @property
        def is_processing(self):
            was_seen, self.was_seen = self.was_seen, True
            if not was_seen:
                near.recv(3)
            return was_seen

    topic = SimpleNamespace(connections=[Reading()])
    monkeypatch.setattr(connections, "get_topic_manager", lambda: SimpleNamespace(subs={TOPIC: topic}))
    with near, far:
        assert connections.has_unprocessed()


def test_a_connection_may_be_closed_during_the_look(monkeypatch):
    """rospy closes it in its own thread, when the publisher has ended."""
    near, far = socket.socketpair()

    class Closing:
        """A connection that is closed after the first look at its socket."""

        was_seen = False

        @property
        def socket(self):
            was_seen, self.was_seen = self.was_seen, True
            return None if was_seen else near

    topic = SimpleNamespace(connections=[Closing()])
    monkeypatch.setattr(connections, "get_topic_manager", lambda: SimpleNamespace(subs={TOPIC: topic}))
    far.sendall(b"one")
    with near, far:
        assert connections.has_unprocessed()
