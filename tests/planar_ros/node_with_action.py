#!/usr/bin/env python3
"""A node whose action server accepts goals and never finishes one."""

from move_base_msgs.msg import MoveBaseAction

from planar_ros.calls.actions import ActionServer
from planar_ros.node.runner import run


def start():
    server = ActionServer("errand", MoveBaseAction, auto_start=False)
    server.register_goal_callback(server.accept_new_goal)
    server.start()
    return server


run("node_with_action", start)
