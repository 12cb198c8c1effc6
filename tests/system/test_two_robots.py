#!/usr/bin/env python3
"""Two robots drive to two goals at once in one world, and do not receive each other's topics."""

import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from goals import goal_at
from ground_truth import wait_for_ground_truth
from move_base_msgs.msg import MoveBaseAction
from nav_msgs.msg import Odometry
from std_msgs.msg import String
from waiting import wait_until

from planar import Pose2
from planar_ros.calls.actions import server_is_ready
from planar_ros.messages.conversion import LaserScanArrays, pose2_from_msg

WALL_DEADLINE = 120.0
ARRIVAL_TOLERANCE = 0.25
GOALS = {"alice": Pose2(-2.0, 1.0, 3.14), "bob": Pose2(2.0, 3.0, 0.0)}


class Witness:
    """What is truly known of one robot."""

    def __init__(self, name):
        self.truth, self.distance, self.frames, self.collisions = None, 0.0, set(), set()
        self.driving = []  # stamps at which it was under way
        self.client = actionlib.SimpleActionClient(f"{name}/move_base", MoveBaseAction)
        rospy.Subscriber(f"{name}/base_pose_ground_truth", Odometry, self._on_truth, queue_size=100)
        rospy.Subscriber(f"{name}/odom", Odometry, self._on_odometry, queue_size=100)
        rospy.Subscriber(f"{name}/scan", LaserScanArrays, self._on_scan, queue_size=10)
        rospy.Subscriber(f"{name}/contacts", String, self._on_contacts, queue_size=100)

    def send(self, pose):
        self.client.send_goal(goal_at(pose))

    def is_active(self):
        return self.client.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE)

    def _on_truth(self, message):
        truth = pose2_from_msg(message.pose.pose)
        if self.truth is not None:
            self.distance += self.truth.distance_to(truth)
        if self.distance > 0.3 and message.twist.twist.linear.x > 0.1:
            self.driving.append(message.header.stamp)
        self.truth, self.stamp = truth, message.header.stamp.to_sec()

    def _on_odometry(self, message):
        self.frames.update((message.header.frame_id, message.child_frame_id))

    def _on_scan(self, message):
        self.frames.add(message.header.frame_id)

    def _on_contacts(self, message):
        self.collisions.update(message.data.split())


class TwoRobotsTest(unittest.TestCase):
    def test_both_arrive_where_they_were_sent(self):
        robots = {name: Witness(name) for name in GOALS}
        wait_until(
            "two robots",
            lambda: all(server_is_ready(one.client) and one.truth and one.frames for one in robots.values()),
            WALL_DEADLINE,
        )
        for name, one in robots.items():
            one.send(GOALS[name])
        wait_until("both results", lambda: not any(one.is_active() for one in robots.values()), WALL_DEADLINE)
        wait_for_ground_truth(lambda: min(one.stamp for one in robots.values()), WALL_DEADLINE)
        first, last = (
            pick(one.driving[end] for one in robots.values()) for pick, end in ((max, 0), (min, -1))
        )
        self.assertLess(first, last, "both drive at once")
        for name, one in robots.items():
            self.assertEqual(one.client.get_state(), GoalStatus.SUCCEEDED, one.client.get_goal_status_text())
            error = one.truth.distance_to(GOALS[name])
            print(f"{name}: truly {error:.3f} m off after {one.distance:.1f} m")
            self.assertLess(error, ARRIVAL_TOLERANCE)
            self.assertEqual(one.collisions, set())
            self.assertEqual(one.frames, {f"{name}/{frame}" for frame in ("odom", "base_footprint", "laser")})


if __name__ == "__main__":
    rospy.init_node("test_two_robots")
    rostest.rosrun("home_service_tests", "two_robots", TwoRobotsTest)
