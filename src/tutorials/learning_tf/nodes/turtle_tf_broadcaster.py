#!/usr/bin/env python3
"""Broadcast the pose of a turtle as a transform from world to the frame of its name.

turtle_tf_broadcaster.py TURTLE
"""

import sys

import rospy
import tf
from turtlesim.msg import Pose


def on_pose(pose, turtle, broadcaster):
    broadcaster.sendTransform(
        (pose.x, pose.y, 0.0),
        tf.transformations.quaternion_from_euler(0.0, 0.0, pose.theta),
        rospy.Time.now(),
        turtle,
        "world",
    )


def main():
    if len(rospy.myargv()) != 2:
        sys.exit(__doc__)
    rospy.init_node("turtle_tf_broadcaster")
    turtle, broadcaster = rospy.myargv()[1], tf.TransformBroadcaster()
    rospy.Subscriber(f"/{turtle}/pose", Pose, lambda pose: on_pose(pose, turtle, broadcaster))
    rospy.spin()


if __name__ == "__main__":
    main()
