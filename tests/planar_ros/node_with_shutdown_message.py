#!/usr/bin/env python3
"""A node that publishes one message at its start and one on shutdown."""

import rospy
from std_msgs.msg import String

from planar_ros.node.runner import run
from planar_ros.node.topics import publish_on_shutdown


def start():
    publisher = rospy.Publisher("farewell", String, queue_size=10, latch=True)
    publisher.publish("here")
    publish_on_shutdown(publisher, String("gone"))
    return publisher


run("node_with_shutdown_message", start)
