"""Ports for a master of one's own."""

import contextlib
import random
import socket

from supervision.errors import LaunchError

FIRST_PORT, FIRST_OUTGOING_PORT = 20000, 32768


def free_port() -> int:
    """A TCP port on the loopback interface that nobody listens on right now.

    It lies below those that the system hands out for outgoing connections: one of these, of another graph for
    example, might take it before a master listens there.
    """
    ports = range(FIRST_PORT, FIRST_OUTGOING_PORT)
    for port in random.Random().sample(ports, len(ports)):
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return port
    raise LaunchError(f"every port from {ports[0]} to {ports[-1]} is in use")
