#!/usr/bin/env python3
"""A node that publishes an answer only after its topics are closed on shutdown."""

import threading
import time

import rospy
from std_msgs.msg import Empty

from planar_ros.node.runner import run
from rospy_transport.node import on_topics_closed


def start():
    answers = rospy.Publisher("answers", Empty, queue_size=1)
    are_closed = threading.Event()

    def answer(message):
        print("asked", flush=True)
        are_closed.wait()
        answers.publish(message)

    def on_closed():
        are_closed.set()
        time.sleep(1.0)

    on_topics_closed(on_closed)
    return rospy.Subscriber("questions", Empty, answer)


run("node_with_late_answer", start)
