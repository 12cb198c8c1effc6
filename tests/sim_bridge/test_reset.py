#!/usr/bin/env python3
"""Resets during a goal: every node survives them and reaches the next goal."""

import math
import unittest

import actionlib
import rosnode
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from geometry_msgs.msg import PoseWithCovarianceStamped
from goals import goal_at
from ground_truth import wait_for_ground_truth
from move_base_msgs.msg import MoveBaseAction
from nav_msgs.msg import Odometry
from std_srvs.srv import Empty
from waiting import wait_until

from planar import Pose2
from planar_ros.messages.transforms import Transforms

NODES = ("/sim_bridge", "/robot_state_publisher", "/map_server", "/amcl", "/move_base")

PATIENCE_SECONDS = 60.0


class TestReset(unittest.TestCase):
    def setUp(self):
        self.truth, self.transforms = [], Transforms()
        rospy.Subscriber("base_pose_ground_truth", Odometry, self.truth.append, queue_size=1000)
        self.initial_pose = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=1)
        wait_until("the simulation", lambda: self.truth, PATIENCE_SECONDS)

    def test_reset_world_in_the_middle_of_a_goal(self):
        self.set_off_for(2.0, 3.0)
        self.reset("/gazebo/reset_world")
        stamps = [message.header.stamp.to_sec() for message in self.truth]
        self.assertEqual(stamps, sorted(stamps), "time goes on")
        self.publish_initial_pose()
        self.assert_nodes_work()

    def test_reset_simulation_in_the_middle_of_a_goal(self):
        self.set_off_for(2.0, 3.0)
        last = self.truth[-1].header.stamp
        first_after = self.reset("/gazebo/reset_simulation")
        self.assertLess(first_after.header.stamp, last, "time restarts")
        self.assertLess(first_after.header.stamp.to_sec(), 5.0)
        self.assert_status_is_published()
        self.publish_initial_pose()
        self.assert_nodes_work()

    def assert_status_is_published(self):
        """Several times: an old timer ends at its first sleep after the jump."""
        statuses = []
        rospy.Subscriber("move_base/status", GoalStatusArray, statuses.append, queue_size=10)
        wait_until("the status of move_base", lambda: len(statuses) >= 5, PATIENCE_SECONDS)

    def start_goal(self, x, y):
        """Send a goal with a new client: an old one keeps its state across a jump of time."""
        client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        wait_until("move_base", lambda: client.wait_for_server(rospy.Duration(0.1)), PATIENCE_SECONDS)
        client.send_goal(goal_at(Pose2(x, y)))
        return client

    def set_off_for(self, x, y):
        here = self.truth[-1].pose.pose.position
        self.start_goal(x, y)
        wait_until("the robot to set off", lambda: self.distance_from(here.x, here.y) > 0.7, PATIENCE_SECONDS)

    def reset(self, name):
        """Reset, and return the first true pose at the start; the robot may drive on at once."""
        rospy.wait_for_service(name, 20.0)
        first = len(self.truth)
        rospy.ServiceProxy(name, Empty)()

        def back():
            return next((truth for truth in self.truth[first:] if distance(truth, 0.0, 0.0) < 0.5), None)

        wait_until("the robot to be back", back, PATIENCE_SECONDS)
        return back()

    def publish_initial_pose(self):
        """Publish the latest true pose as initial pose, as from RViz, while the goal goes on."""
        wait_until("amcl", self.initial_pose.get_num_connections, PATIENCE_SECONDS)
        last = self.truth[-1]
        message = PoseWithCovarianceStamped()
        message.header.stamp, message.header.frame_id = last.header.stamp, "map"
        message.pose.pose = last.pose.pose
        message.pose.covariance[0] = message.pose.covariance[7] = 0.05
        message.pose.covariance[35] = 0.03
        self.initial_pose.publish(message)
        wait_until("localization", lambda: self.estimate_error() < 0.3, PATIENCE_SECONDS)
        later = self.truth[-1].header.stamp + rospy.Duration(0.5)
        wait_until("move_base to know", lambda: self.truth[-1].header.stamp >= later, PATIENCE_SECONDS)

    def estimate_error(self):
        """How far from the truth localization takes the robot to be, metres; unknown is infinitely far."""
        estimate = self.transforms.lookup("map", "base_footprint")
        return math.inf if estimate is None else self.distance_from(estimate.x, estimate.y)

    def assert_nodes_work(self):
        for name in NODES:
            self.assertTrue(rosnode.rosnode_ping(name, max_count=1), f"{name} is gone")
        client = self.start_goal(1.0, 0.3)
        wait_until(
            "the goal",
            lambda: client.get_state() not in (GoalStatus.PENDING, GoalStatus.ACTIVE),
            PATIENCE_SECONDS,
        )
        self.assertEqual(client.get_state(), GoalStatus.SUCCEEDED, client.get_goal_status_text())
        wait_for_ground_truth(lambda: self.truth[-1].header.stamp.to_sec(), PATIENCE_SECONDS)
        self.assertLess(
            self.distance_from(1.0, 0.3), 0.3, f"localization is {self.estimate_error():.2f} m off"
        )

    def distance_from(self, x, y):
        return distance(self.truth[-1], x, y)


def distance(truth, x, y):
    position = truth.pose.pose.position
    return math.hypot(position.x - x, position.y - y)


if __name__ == "__main__":
    rospy.init_node("reset_test")
    rostest.rosrun("home_service_tests", "reset", TestReset)
