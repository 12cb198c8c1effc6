"""Connections of rospy's publishers whose remote socket belongs to the test, without a master."""

import socket

import pytest
import rospy
from std_msgs.msg import String

from planar_ros.lockstep.transport import LockstepConnection
from rospy_transport.connections import connect
from rospy_transport.replacements import install, uninstall


@pytest.fixture
def publisher():
    """Makes publishers whose connections are those of synchronized nodes."""
    install(LockstepConnection)
    publishers = {}

    def made(topic):
        if topic not in publishers:
            publishers[topic] = rospy.Publisher(topic, String, queue_size=50)
        return publishers[topic]

    yield made
    for each in publishers.values():
        each.unregister()  # ends the threads of its connections, for which Python would wait at exit
    uninstall()


@pytest.fixture
def connected(publisher):
    """Connects a node to a topic; returns the remote socket and the connection."""
    ends = []

    def connected(node, topic):
        near, far = socket.socketpair()
        ends.append(far)
        return far, connect(publisher(topic), node, near)

    yield connected
    for end in ends:
        end.close()
