#!/usr/bin/env python3
"""Spawn a second turtle: a client of the service /spawn.

a_new_turtle.py [NAME [X Y THETA]]
"""

import sys

import rospy
from turtlesim.srv import Spawn


def spawn(name="turtle2", x="2.0", y="2.0", theta="0.0"):
    rospy.wait_for_service("/spawn", timeout=10.0)
    return rospy.ServiceProxy("/spawn", Spawn)(float(x), float(y), float(theta), name).name


if __name__ == "__main__":
    rospy.init_node("a_new_turtle")
    try:
        rospy.loginfo("spawned: %s", spawn(*rospy.myargv()[1:]))
    except (rospy.ServiceException, rospy.ROSException, TypeError, ValueError) as error:
        sys.exit(f"no turtle: {error}")
