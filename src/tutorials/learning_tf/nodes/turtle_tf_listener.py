#!/usr/bin/env python3
"""Spawn turtle2 and make it follow turtle1, by the transform from turtle2 to turtle1."""

import math

import rospy
import tf
from geometry_msgs.msg import Twist
from turtlesim.srv import Spawn

# Gains from distance to linear velocity and from bearing to angular velocity [1/s].
LINEAR_GAIN, ANGULAR_GAIN = 0.5, 4.0


def spawn():
    rospy.wait_for_service("/spawn", timeout=10.0)
    try:
        rospy.ServiceProxy("/spawn", Spawn)(4.0, 2.0, 0.0, "turtle2")
    except rospy.ServiceException:
        rospy.loginfo("turtle2 exists already")


def follow():
    listener = tf.TransformListener()
    publisher = rospy.Publisher("/turtle2/cmd_vel", Twist, queue_size=1)
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        rate.sleep()
        try:
            (x, y, _), _ = listener.lookupTransform("turtle2", "turtle1", rospy.Time(0))
        except tf.Exception:
            continue  # no transform of one of them yet
        twist = Twist()
        twist.linear.x = LINEAR_GAIN * math.hypot(x, y)
        twist.angular.z = ANGULAR_GAIN * math.atan2(y, x)
        publisher.publish(twist)


if __name__ == "__main__":
    rospy.init_node("turtle_tf_listener")
    try:
        spawn()
        follow()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping
