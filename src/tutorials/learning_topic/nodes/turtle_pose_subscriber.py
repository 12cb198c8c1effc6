#!/usr/bin/env python3
"""Log the pose of the turtle: subscribes to /turtle1/pose."""

import rospy
from turtlesim.msg import Pose


def on_pose(pose):
    """Called for each message, in a thread of rospy."""
    rospy.loginfo_throttle(1.0, "turtle pose: x %.2f, y %.2f, theta %.2f", pose.x, pose.y, pose.theta)


if __name__ == "__main__":
    rospy.init_node("turtle_pose_subscriber", anonymous=True)
    rospy.Subscriber("/turtle1/pose", Pose, on_pose)
    rospy.spin()
