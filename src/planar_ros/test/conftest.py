"""rospy connections whose remote socket belongs to the test."""

import socket
from types import SimpleNamespace

import pytest

from planar_ros.lockstep.transport import LockstepConnection


@pytest.fixture
def connected():
    """Connects a node to a topic; returns the remote socket and the connection."""
    ends, transports = [], []

    def connected(node, topic):
        near, far = socket.socketpair()
        ends.extend((near, far))
        plain = SimpleNamespace(
            endpoint_id=node,
            protocol=SimpleNamespace(resolved_name=topic),
            socket=near,
            done=False,
            stat_bytes=0,
            stat_num_msg=0,
            write_data=near.sendall,
        )
        plain.set_cleanup_callback = lambda callback: setattr(plain, "closed", callback)
        transports.append(plain)
        return far, LockstepConnection(plain, 50)

    yield connected
    for transport in transports:  # ends the thread of its connection, for which Python would wait at exit
        transport.done = True
        transport.closed(transport)
    for end in ends:
        end.close()
