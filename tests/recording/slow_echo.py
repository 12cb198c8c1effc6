#!/usr/bin/env python3
"""Echoes numbers, but starts to send well after a subscriber has counted the connection."""

import time

import rospy
from std_msgs.msg import Int32

DELAY_SECONDS = 0.3

if __name__ == "__main__":
    rospy.init_node("slow_echo")
    echo = rospy.Publisher("echo", Int32, queue_size=1)
    add_connection = echo.impl.add_connection

    def add_late(connection):
        time.sleep(DELAY_SECONDS)
        return add_connection(connection)

    echo.impl.add_connection = add_late
    rospy.Subscriber("numbers", Int32, echo.publish)
    rospy.spin()
