#!/usr/bin/env python3
"""A node in which a thread raises: a timer, or a thread of its module, by the argument."""

import sys
import threading

import rospy

from planar_ros.node.runner import run


def fail():
    raise ValueError("no way on")


def fail_in_timer(_event):
    fail()


def start():
    if sys.argv[1] == "timer":
        return rospy.Timer(rospy.Duration(0.05), fail_in_timer)
    worker = threading.Thread(target=fail, name="worker", daemon=True)
    worker.start()
    return worker


run("node_with_failing_thread", start)
