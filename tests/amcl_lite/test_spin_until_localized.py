#!/usr/bin/env python3
"""A robot with a wrong estimate turns until it is localized; with a wrong map this fails with an error."""

import subprocess
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from simple_robot import room
from waiting import PATIENCE_SECONDS

from planar import wrap
from planar_ros.messages.conversion import SetMapArrays, grid_to_msg, pose2_from_msg

NEAR = 0.15  # metres


def spin(*arguments):
    command = ["rosrun", "amcl_lite", "spin_until_localized", *arguments]
    return subprocess.run(command, capture_output=True, timeout=60.0, check=False)


class SpinUntilLocalizedTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_spin_until_localized")
        rospy.wait_for_service("global_localization", 30.0)

    def test_1_a_robot_is_localized_from_an_unknown_pose(self):
        done = spin("--timeout", "60")
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        self.assertIn("localized at", done.stdout.decode())
        found = pose2_from_msg(
            rospy.wait_for_message("amcl_pose", PoseWithCovarianceStamped, PATIENCE_SECONDS).pose.pose
        )
        truth = pose2_from_msg(
            rospy.wait_for_message("base_pose_ground_truth", Odometry, PATIENCE_SECONDS).pose.pose
        )
        # Since the last pose the robot may have turned, but not driven.
        self.assertLess(found.distance_to(truth), NEAR)

    def test_2_the_robot_stands_still_afterwards(self):
        before, after = (self.heading_after(seconds) for seconds in (1.0, 1.0))
        self.assertLess(abs(wrap(after - before)), 0.01)

    def test_3_with_a_map_of_another_place_localization_fails(self):
        request = SetMapArrays._request_class()
        request.map = grid_to_msg(room(), rospy.Time.now(), "map")
        request.initial_pose.header.frame_id = "map"
        request.initial_pose.pose.pose.orientation.w = 1.0
        request.initial_pose.pose.covariance = 0.01 * np.eye(6).ravel()
        self.assertTrue(rospy.ServiceProxy("set_map", SetMapArrays)(request).success)
        done = spin("--timeout", "10")
        self.assertEqual(done.returncode, 1)
        self.assertIn("not localized within 10 s", done.stderr.decode())

    def test_4_a_missing_localization_is_reported(self):
        done = spin("global_localization:=nowhere")
        self.assertEqual(done.returncode, 1)
        self.assertIn("no service /nowhere", done.stderr.decode())

    def test_5_a_negative_timeout_is_rejected(self):
        self.assertEqual(spin("--timeout", "-3").returncode, 2)

    def heading_after(self, seconds):
        rospy.sleep(seconds)
        message = rospy.wait_for_message("base_pose_ground_truth", Odometry, PATIENCE_SECONDS)
        return pose2_from_msg(message.pose.pose).yaw


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "spin", SpinUntilLocalizedTest)
