#!/usr/bin/env python3
"""ROBOTIS' simulation chapter: the robot in turtlebot3_world, with the official names."""

import os
import pty
import signal
import subprocess
import unittest

import actionlib
import rospy
import rostest
from gazebo_msgs.msg import ModelStates
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from goals import goal_at
from move_base_msgs.msg import MoveBaseAction
from sensor_msgs.msg import Imu, JointState, LaserScan
from turtlebot3_msgs.msg import SensorState, Sound, VersionInfo
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit
from waiting import PATIENCE_SECONDS, wait_until

from planar import Pose2
from planar_ros.calls.actions import server_is_ready
from planar_ros.messages.conversion import pose2_from_msg, pose2_to_msg
from planar_ros.node.topics import has_all_subscribers

BRING_UP_SECONDS, EXIT_SECONDS = 90.0, 10.0
START, GOAL = Pose2(-2.0, -0.5), Pose2(0.55, -1.8)
MD5 = {
    SensorState: "7250c1dc0b61c4190e78f528f599285f",
    Sound: "e1f8c7f8a9a61383b5734fbdeca2f99a",
    VersionInfo: "43e0361461af2970a33107409403ef3c",
}


class TurtleBot3Test(unittest.TestCase):
    def test_1_the_messages_are_the_official_ones(self):
        for message, md5 in MD5.items():
            self.assertEqual(message._md5sum, md5, message._type)

    def test_2_the_topics_match_the_official_ones(self):
        scan = rospy.wait_for_message("scan", LaserScan, BRING_UP_SECONDS)
        self.assertEqual((len(scan.ranges), scan.header.frame_id), (360, "base_scan"))
        self.assertAlmostEqual(scan.range_max, 3.5, places=5)
        stamps = []
        subscriber = rospy.Subscriber(
            "scan", LaserScan, lambda scan: stamps.append(scan.header.stamp.to_sec())
        )
        wait_until("six scans", lambda: len(stamps) > 5, PATIENCE_SECONDS)
        subscriber.unregister()
        gaps = [later - earlier for earlier, later in zip(stamps, stamps[1:])]
        self.assertAlmostEqual(min(gaps), 0.2, places=5)
        joints = rospy.wait_for_message("joint_states", JointState, PATIENCE_SECONDS)
        self.assertEqual(set(joints.name), {"wheel_left_joint", "wheel_right_joint"})
        self.assertEqual(rospy.wait_for_message("imu", Imu, PATIENCE_SECONDS).header.frame_id, "imu_link")
        self.assertLess(self._truth().distance_to(START), 0.05)

    def test_3_it_drives_to_a_goal_after_an_initial_pose(self):
        publisher = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=1, latch=True)
        pose = PoseWithCovarianceStamped()
        pose.header.frame_id, pose.pose.pose = "map", pose2_to_msg(START)
        pose.pose.covariance[0] = pose.pose.covariance[7] = 0.25
        pose.pose.covariance[35] = 0.07
        publisher.publish(pose)
        wait_until(
            "the estimate to follow the initial pose",
            lambda: self._estimate().distance_to(START) < 0.3,
            BRING_UP_SECONDS,
        )
        client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        wait_until("move_base", lambda: server_is_ready(client), BRING_UP_SECONDS)
        self.assertEqual(client.send_goal_and_wait(goal_at(GOAL), rospy.Duration(200.0)), 3)
        error = self._truth().distance_to(GOAL)
        print(f"true distance from the goal: {error:.3f} m")
        self.assertLess(error, 0.25)

    def test_4_the_interactive_marker_drives_the_robot(self):
        full = "/turtlebot3_marker_server/update_full"
        (marker,) = rospy.wait_for_message(full, InteractiveMarkerInit, PATIENCE_SECONDS).markers
        self.assertEqual({one.name for one in marker.controls}, {"move_x", "rotate_z"})
        feedback = rospy.Publisher(
            "/turtlebot3_marker_server/feedback", InteractiveMarkerFeedback, queue_size=1
        )
        drawn = InteractiveMarkerFeedback(client_id="test", marker_name=marker.name)
        drawn.event_type, drawn.pose = (
            InteractiveMarkerFeedback.POSE_UPDATE,
            pose2_to_msg(Pose2(0.1, 0.0, 0.2)),
        )
        drawn.header.frame_id = marker.header.frame_id
        commands = []
        rospy.Subscriber("cmd_vel", Twist, lambda twist: commands.append((twist.linear.x, twist.angular.z)))
        wait_until("the subscriber of the feedback", lambda: has_all_subscribers(feedback), PATIENCE_SECONDS)
        before = self._truth()

        def has_moved():
            feedback.publish(drawn)
            return self._truth().distance_to(before) > 0.1

        wait_until("the robot to move", has_moved, PATIENCE_SECONDS)
        self.assertIn((0.1, 0.44), [(round(v, 6), round(omega, 6)) for v, omega in commands])

    def test_5_programs_that_wait_for_input_end_on_sigint(self):
        for command in ("turtlebot3_client", "turtlebot3_pointop_key"):
            keyboard, terminal = pty.openpty()
            waiting = subprocess.Popen(
                ["rosrun", "turtlebot3_example", command],
                stdin=terminal,
                stdout=subprocess.PIPE,
                start_new_session=True,
            )
            self.assertTrue(any(b"close" in line for line in waiting.stdout))
            waiting.send_signal(signal.SIGINT)
            self.assertEqual(waiting.wait(EXIT_SECONDS), 0, command)
            for end in (keyboard, terminal):
                os.close(end)

    def _truth(self):
        states = rospy.wait_for_message("/gazebo/model_states", ModelStates, PATIENCE_SECONDS)
        return pose2_from_msg(states.pose[states.name.index("turtlebot3_burger")])

    def _estimate(self):
        message = rospy.wait_for_message("amcl_pose", PoseWithCovarianceStamped, BRING_UP_SECONDS)
        return pose2_from_msg(message.pose.pose)


if __name__ == "__main__":
    rospy.init_node("test_turtlebot3")
    rostest.rosrun("home_service_tests", "turtlebot3", TurtleBot3Test)
