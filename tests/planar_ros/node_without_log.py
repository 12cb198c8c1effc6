#!/usr/bin/env python3
"""A node whose log file becomes unwritable after its start, and that logs on shutdown."""

import resource

import rospy

from planar_ros.node.runner import run


def start():
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
    rospy.on_shutdown(lambda: rospy.logwarn("the node ends"))
    print("up", flush=True)


run("node_without_log", start)
