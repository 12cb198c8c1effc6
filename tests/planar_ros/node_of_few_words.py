#!/usr/bin/env python3
"""A node that says two words, the last with a number, and ends."""

import rospy
from std_msgs.msg import String

from planar_ros.node.last_words import wait_until_heard
from planar_ros.node.shell import run


def start():
    words = rospy.Publisher("words", String, queue_size=10, latch=True)
    words.publish("nearly")
    words.publish(f"delivered {rospy.get_param('~number')}")
    wait_until_heard(words)
    rospy.signal_shutdown("all is said")


run("node_of_few_words", start)
