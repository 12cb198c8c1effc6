#!/usr/bin/env python3
"""Spawns turtle2 and makes it follow turtle1: tf says where turtle1 is, seen from turtle2."""

import math

import rospy
import tf
from geometry_msgs.msg import Twist
from turtlesim.srv import Spawn

# Speeds by how far away turtle1 is (1/s) and by the angle to it (1/s).
PER_DISTANCE, PER_ANGLE = 0.5, 4.0


def spawn():
    rospy.wait_for_service("/spawn", timeout=10.0)
    try:
        rospy.ServiceProxy("/spawn", Spawn)(4.0, 2.0, 0.0, "turtle2")
    except rospy.ServiceException:
        rospy.loginfo("there is a turtle2 already")


def follow():
    listener = tf.TransformListener()
    publisher = rospy.Publisher("/turtle2/cmd_vel", Twist, queue_size=1)
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        rate.sleep()
        try:
            (x, y, _), _ = listener.lookupTransform("turtle2", "turtle1", rospy.Time(0))
        except tf.Exception:
            continue  # one of them has not told yet where it is
        twist = Twist()
        twist.linear.x = PER_DISTANCE * math.hypot(x, y)
        twist.angular.z = PER_ANGLE * math.atan2(y, x)
        publisher.publish(twist)


if __name__ == "__main__":
    rospy.init_node("turtle_tf_listener")
    try:
        spawn()
        follow()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while it slept
