#!/usr/bin/env python3
"""Navigation in the whole graph, judged by ground truth: goals, an obstacle no map shows, no way."""

import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from goals import goal_at
from ground_truth import wait_for_ground_truth
from move_base_msgs.msg import MoveBaseAction
from visualization_msgs.msg import Marker

from evaluation.consumers.referee import Referee
from evaluation.ros.run_topics import observe
from planar import Pose2
from planar_ros.calls.actions import server_is_ready
from planar_ros.messages.conversion import pose2_to_msg

ARRIVAL_TOLERANCE = 0.25
SIMULATED_DEADLINE = 120.0
WALL_DEADLINE = 120.0
BED = Pose2(-5.5, 3.8)


class NavigationTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.referee = Referee({}, print)
        observe(cls.referee)
        cls.client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        cls.boxes = rospy.Publisher("sim_bridge/add_box", Marker, queue_size=10)

    def setUp(self):
        self._wait("move_base and ground truth", lambda: server_is_ready(self.client) and self.referee.truth)

    def test_1_two_goals_are_reached_one_after_the_other(self):
        for goal in (Pose2(3.0, 0.0, 1.57), Pose2(2.0, 3.0, 0.0)):
            self._assert_reached(goal)

    def test_2_a_box_dropped_into_the_path_is_driven_around(self):
        self._assert_reached(Pose2(3.5, 0.2, 3.14))
        self._wait("a subscriber of boxes", lambda: self.boxes.get_num_connections() > 0)
        goal = Pose2(-0.3, 0.2, 3.14)
        self._send(goal)
        self._wait("motion", lambda: self.referee.truth.x < 3.3)
        self._drop_box(Pose2(1.0, self.referee.truth.y))
        self._assert_arrival(goal)

    def test_3_a_goal_in_an_obstacle_is_aborted_with_a_reason(self):
        self._send(BED)
        self._wait_for_result(BED)
        self.assertEqual(self.client.get_state(), GoalStatus.ABORTED)
        text = self.client.get_goal_status_text()
        self.assertTrue(text.startswith("Failed to find a valid plan."), text)
        self.assertIn("obstacle of the map", text)

    def _drop_box(self, pose):
        box = Marker(ns="box", type=Marker.CUBE)
        box.pose = pose2_to_msg(pose)
        box.scale.x = box.scale.y = box.scale.z = 0.5
        self.boxes.publish(box)

    def _assert_reached(self, goal):
        self._send(goal)
        self._assert_arrival(goal)

    def _assert_arrival(self, goal):
        self._wait_for_result(goal)
        self.assertEqual(self.client.get_state(), GoalStatus.SUCCEEDED, self.client.get_goal_status_text())
        wait_for_ground_truth(lambda: self.referee.simulated_time, WALL_DEADLINE)
        error = self.referee.truth.distance_to(goal)
        print(f"goal ({goal.x}, {goal.y}): truly {error:.3f} m off")
        self.assertLess(error, ARRIVAL_TOLERANCE)
        self.assertEqual(self.referee.mission_record.collisions, [])

    def _send(self, pose):
        self.client.send_goal(goal_at(pose))

    def _wait_for_result(self, pose):
        active = (GoalStatus.PENDING, GoalStatus.ACTIVE)
        self._wait(f"result at ({pose.x}, {pose.y})", lambda: self.client.get_state() not in active)

    def _wait(self, what, is_there):
        wall, simulated = time.monotonic() + WALL_DEADLINE, self.referee.simulated_time + SIMULATED_DEADLINE
        while not is_there():
            self.assertLess(self.referee.simulated_time, simulated, f"no {what}")
            self.assertLess(time.monotonic(), wall, f"no {what}")
            time.sleep(0.02)


if __name__ == "__main__":
    rospy.init_node("test_navigation")
    rostest.rosrun("home_service_tests", "navigation", NavigationTest)
