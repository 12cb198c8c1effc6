#!/usr/bin/env python3
"""A node that publishes an answer only after its topics are closed on shutdown."""

import time

import rospy
from std_msgs.msg import Empty

from planar_ros.node.runner import run


def start():
    answers = rospy.Publisher("answers", Empty, queue_size=1)
    topic = answers.impl

    def answer(message):
        print("asked", flush=True)
        while not topic.closed:
            time.sleep(0.01)
        answers.publish(message)

    rospy.core.add_preshutdown_hook(lambda _reason: time.sleep(1.0))
    return rospy.Subscriber("questions", Empty, answer)


run("node_with_late_answer", start)
