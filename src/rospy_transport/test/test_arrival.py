"""Whether messages have reached their receiver, and whether it has closed the connection."""

import fcntl
import socket
import struct
import termios

import pytest
import rospy
from std_msgs.msg import String

from rospy_transport import connections
from rospy_transport.arrival import has_arrived

NODE = "/subscriber"
# More messages than TCP acknowledges at once after a connection has begun.
MESSAGES = 50


@pytest.fixture(params=[(socket.AF_INET, "127.0.0.1"), (socket.AF_INET6, "::1")])
def ends(request, opened):
    family, address = request.param
    listening = opened(socket.socket(family))
    listening.bind((address, 0))
    listening.listen()
    far = opened(socket.create_connection(listening.getsockname()[:2]))
    near = opened(listening.accept()[0])
    near.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return near, far


def unacknowledged(end):
    return struct.unpack("i", fcntl.ioctl(end.fileno(), termios.TIOCOUTQ, bytes(4)))[0]


def test_what_is_not_acknowledged_yet_has_arrived(ends):
    near, far = ends
    for _ in range(MESSAGES):
        near.send(b"message")
        far.recv(100)
    near.send(b"message")
    assert unacknowledged(near) > 0
    assert has_arrived(near)


def test_what_does_not_fit_into_the_buffer_of_the_receiver_has_not_arrived(ends):
    near, far = ends
    near.setblocking(False)
    with pytest.raises(BlockingIOError):
        while True:
            near.send(bytes(1 << 16))
    assert not has_arrived(near)


def test_of_another_kind_of_connection_nothing_is_known(opened):
    near, far = map(opened, socket.socketpair())
    near.send(b"message")
    assert has_arrived(near)


def test_messages_under_way_to_some_receivers(ends, opened):
    near, far = ends
    publisher = opened(rospy.Publisher("/topic", String, queue_size=1))
    connections.connect(publisher, NODE, near)
    assert not connections.has_undelivered({NODE})
    publisher.publish("now")
    far.recv(100)
    assert not connections.has_undelivered({NODE})
    near.setblocking(False)
    with pytest.raises(BlockingIOError):
        while True:
            near.send(bytes(1 << 16))
    assert connections.has_undelivered({NODE})
    assert not connections.has_undelivered({"/another"})


def test_a_connection_that_its_receiver_has_closed_is_dropped_before_the_next_message(ends, opened):
    near, far = ends
    publisher = opened(rospy.Publisher("/topic", String, queue_size=1))
    connections.connect(publisher, NODE, near)
    assert not connections.drop_closed()
    assert publisher.get_num_connections() == 1
    far.close()
    assert connections.drop_closed()
    assert publisher.get_num_connections() == 0
    assert not connections.drop_closed()
