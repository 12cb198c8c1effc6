"""rospy connections whose remote socket belongs to the test."""

import socket
from types import SimpleNamespace

import pytest

from planar_ros.lockstep.transport import LockstepConnection


@pytest.fixture
def connected():
    """Connects a node to a topic; returns the remote socket and the connection."""
    ends = []

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
            set_cleanup_callback=lambda callback: None,
            write_data=near.sendall,
        )
        return far, LockstepConnection(plain, 50)

    yield connected
    for end in ends:
        end.close()
