"""Messages are sent immediately, in order and complete, and a slow subscriber delays no other."""

import socket
import threading
import time
from types import SimpleNamespace

import pytest

from rospy_transport.replacements import ImmediateConnection


class Transport:
    """The part of TCPROSTransport that a connection uses."""

    def __init__(self, end):
        self.socket, self.done, self.stat_bytes, self.stat_num_msg = end, False, 0, 0
        self.endpoint_id, self.protocol = "/subscriber", SimpleNamespace(resolved_name="/topic")
        self.senders = []

    def set_cleanup_callback(self, callback):
        self.close = lambda: (setattr(self, "done", True), callback(self))

    def write_data(self, data):
        self.senders.append(threading.current_thread())
        self.socket.sendall(data)


@pytest.fixture
def ends():
    near, far = socket.socketpair()
    yield Transport(near), far
    near.close()
    far.close()


def read(end, count):
    content = b""
    end.settimeout(5.0)
    while len(content) < count:
        content += end.recv(1 << 16)
    return content


def test_messages_that_fit_the_socket_buffer_are_sent_by_the_calling_thread(ends):
    transport, far = ends
    connection = ImmediateConnection(transport, 10)
    for number in range(100):
        connection.write_data(b"%03d" % number)
    assert read(far, 300) == b"".join(b"%03d" % number for number in range(100))
    assert transport.senders == []
    transport.close()


def test_a_slow_subscriber_does_not_block_and_receives_complete_messages_in_order(ends):
    transport, far = ends
    connection = ImmediateConnection(transport, 3)
    size = 50_000
    start = time.monotonic()
    for number in range(50):
        connection.write_data(bytes([number]) * size)
    assert time.monotonic() - start < 1.0
    content = b""
    while not content.endswith(bytes([49]) * size):
        content += read(far, 1)
    received = [content[at : at + size] for at in range(0, len(content), size)]
    assert all(len(set(message)) == 1 for message in received), "no message is torn"
    numbers = [message[0] for message in received]
    assert numbers == sorted(set(numbers))
    assert len(numbers) < 50, "the oldest of the queue were dropped"
    transport.close()


def test_an_error_is_raised_by_the_next_message(ends):
    transport, far = ends
    connection = ImmediateConnection(transport, 3)
    far.close()
    with pytest.raises(OSError):
        for _ in range(100):
            connection.write_data(b"lost")
            time.sleep(0.01)
    transport.close()
