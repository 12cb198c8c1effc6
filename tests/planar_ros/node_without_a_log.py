#!/usr/bin/env python3
"""A node whose log can be written no more, from the moment on at which it is up, and that logs at its end."""

import resource

import rospy

from planar_ros.node.runner import run


def start():
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
    rospy.on_shutdown(lambda: rospy.logwarn("the node ends"))
    print("up", flush=True)


run("node_without_a_log", start)
