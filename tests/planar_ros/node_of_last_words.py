#!/usr/bin/env python3
"""A node that says a word when it begins and another when it is ended."""

import rospy
from std_msgs.msg import String

from planar_ros.node.flush import publish_on_shutdown
from planar_ros.node.runner import run


def start():
    words = rospy.Publisher("farewell", String, queue_size=10, latch=True)
    words.publish("here")
    publish_on_shutdown(words, String("gone"))
    return words


run("node_of_last_words", start)
