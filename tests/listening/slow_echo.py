#!/usr/bin/env python3
"""Publishes what it hears, but begins to send well after a subscriber has counted the connection."""

import time

import rospy
from std_msgs.msg import Int32

DELAY_SECONDS = 0.3

if __name__ == "__main__":
    rospy.init_node("slow_echo")
    told = rospy.Publisher("told", Int32, queue_size=1)
    add_connection = told.impl.add_connection

    def add_late(connection):
        time.sleep(DELAY_SECONDS)
        return add_connection(connection)

    told.impl.add_connection = add_late
    rospy.Subscriber("asked", Int32, told.publish)
    rospy.spin()
