#!/usr/bin/env python3
"""An initial pose with a stamp in the future, as from a click in rviz, does not block synchronized amcl."""

import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from waiting import wait_until

PATIENCE_SECONDS = 60.0


class TestEarlyPose(unittest.TestCase):
    def setUp(self):
        self.truth, self.words = [], []
        rospy.Subscriber("base_pose_ground_truth", Odometry, self.truth.append, queue_size=1000)
        rospy.Subscriber("/rosout", Log, lambda log: self.words.append(log.msg), queue_size=1000)
        self.initial_pose = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=1)
        wait_until("the simulation", lambda: self.truth, PATIENCE_SECONDS)
        wait_until("amcl", self.initial_pose.get_num_connections, PATIENCE_SECONDS)

    def test_a_pose_of_the_near_future_is_used_at_its_stamp(self):
        self.publish_initial_pose(0.3)
        self.assert_used()
        self.assertNotIn("no odometry at its stamp", " ".join(self.words))

    def test_a_pose_of_the_far_future_is_used_as_of_now(self):
        self.publish_initial_pose(1000.0)
        self.assert_used()
        wait_until("a warning", lambda: any("no odometry at its stamp" in text for text in self.words), 20.0)

    def publish_initial_pose(self, seconds_ahead):
        truth, message = self.truth[-1], PoseWithCovarianceStamped()
        message.header.frame_id = "map"
        message.header.stamp = truth.header.stamp + rospy.Duration(seconds_ahead)
        message.pose.pose = truth.pose.pose
        message.pose.covariance = [0.02 if i in (0, 7, 35) else 0.0 for i in range(36)]
        self.words.clear()
        self.initial_pose.publish(message)

    def assert_used(self):
        wait_until("the pose to be used", lambda: any("Setting pose" in text for text in self.words), 30.0)
        count = len(self.truth)
        wait_until("a second to pass", lambda: len(self.truth) > count + 50, 30.0)
        self.assertFalse([text for text in self.words if "no progress of" in text])


if __name__ == "__main__":
    rospy.init_node("early_pose")
    rostest.rosrun("home_service_tests", "early_pose", TestEarlyPose)
