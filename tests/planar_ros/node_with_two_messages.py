#!/usr/bin/env python3
"""A node that publishes two messages, the last with a number, and ends."""

import rospy
from std_msgs.msg import String

from planar_ros.node.runner import run
from planar_ros.node.topics import flush_and_close


def start():
    publisher = rospy.Publisher("words", String, queue_size=10, latch=True)
    publisher.publish("nearly")
    publisher.publish(f"delivered {rospy.get_param('~number')}")
    flush_and_close(publisher)
    rospy.signal_shutdown("done")


run("node_with_two_messages", start)
