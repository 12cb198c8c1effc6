#!/usr/bin/env python3
"""A node that says two words, the last with a number, and ends."""

import rospy
from std_msgs.msg import String

from planar_ros.node.flush import flush_and_close
from planar_ros.node.runner import run


def start():
    words = rospy.Publisher("words", String, queue_size=10, latch=True)
    words.publish("nearly")
    words.publish(f"delivered {rospy.get_param('~number')}")
    flush_and_close(words)
    rospy.signal_shutdown("all is said")


run("node_of_few_words", start)
