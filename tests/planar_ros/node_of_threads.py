#!/usr/bin/env python3
"""A node in which a thread, named by the argument, does what its name says."""

import sys
import threading

import rospy

from planar_ros.node.runner import run


def die():
    raise ValueError("no way on")


def die_in_a_timer(_event):
    die()


def start():
    if sys.argv[1] == "timer":
        return rospy.Timer(rospy.Duration(0.05), die_in_a_timer)
    worker = threading.Thread(target=die, name="worker", daemon=True)
    worker.start()
    return worker


run("node_of_threads", start)
