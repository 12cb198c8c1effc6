#!/usr/bin/env python3
"""Echoes numbers, but starts to send well after a subscriber has counted the connection."""

import time

import rospy
from std_msgs.msg import Int32

from rospy_transport.replacements import ImmediateConnection, install

DELAY_SECONDS = 0.3


class LateConnection(ImmediateConnection):
    """A connection that a publisher can use only after a delay."""

    def __init__(self, connection, queue_size):
        super().__init__(connection, queue_size)
        if self.topic == rospy.resolve_name("echo"):
            time.sleep(DELAY_SECONDS)


if __name__ == "__main__":
    install(LateConnection)
    rospy.init_node("slow_echo")
    echo = rospy.Publisher("echo", Int32, queue_size=1)
    rospy.Subscriber("numbers", Int32, echo.publish)
    rospy.spin()
