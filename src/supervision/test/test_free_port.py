import socket
from pathlib import Path

from supervision.ros.graph import free_port

OUTGOING = Path("/proc/sys/net/ipv4/ip_local_port_range")


def test_the_port_of_a_master_is_none_that_an_outgoing_connection_may_take():
    first, last = map(int, OUTGOING.read_text(encoding="ascii").split())
    assert not any(first <= free_port() <= last for _ in range(100))


def test_a_port_with_a_listener_is_not_free():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", free_port()))
        taken.listen()
        assert all(free_port() != taken.getsockname()[1] for _ in range(100))
