#!/usr/bin/env python3
"""The commander's commands, judged against ground truth."""

import math
import unittest

import rospy
import rostest
from ground_truth import wait_for_ground_truth
from waiting import wait_until

from evaluation.consumers.referee import Referee
from evaluation.ros.run_topics import observe
from home_service import Commander, CommanderError, Result
from planar import Pose2, wrap
from planar_ros.calls.load_map import LoadMap

WALL_DEADLINE = 60.0
BED = (-5.5, 3.8, 0.0)


class CommanderTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.referee = Referee({}, print)
        observe(cls.referee)
        cls.robot = Commander()

    def setUp(self):
        self.assertTrue(self.robot.is_ready(timeout=60.0), self.robot.waiting_for)
        wait_until("the ground truth", lambda: self.referee.truth is not None, WALL_DEADLINE)

    def test_1_what_is_missing_is_named(self):
        lonely = Commander(base_frame_id="no_such_frame")
        self.assertFalse(lonely.is_ready(timeout=0.5))
        self.assertEqual(lonely.waiting_for, ["the transform map to no_such_frame"])
        with self.assertRaisesRegex(CommanderError, "no command was given yet"):
            lonely.outcome()

    def test_2_a_turn_and_a_reverse_motion_have_the_requested_length(self):
        start = self.referee.truth
        self.robot.spin(math.pi / 2.0)
        self._assert_result(Result.SUCCEEDED)
        turned = float(wrap(self.referee.truth.yaw - start.yaw))
        self.robot.spin(-math.pi / 2.0)
        self._assert_result(Result.SUCCEEDED)
        before = self.referee.truth
        self.robot.back_up(0.3)
        self._assert_result(Result.SUCCEEDED)
        way = before.inverse() @ self.referee.truth
        print(f"turned {turned:.3f} rad, backed up {way.x:.3f} m, {way.y:.3f} m aside")
        self.assertAlmostEqual(turned, math.pi / 2.0, delta=0.15)
        self.assertAlmostEqual(way.x, -0.3, delta=0.08)
        self.assertAlmostEqual(way.y, 0.0, delta=0.05)

    def test_3_a_drive_is_cancelled(self):
        self.robot.go_to(2.0, 3.0)
        wait_until("a drive of some seconds", lambda: self.robot.feedback().seconds > 1.5, WALL_DEADLINE)
        with self.assertRaisesRegex(CommanderError, "has not ended yet"):
            self.robot.outcome()
        self.robot.cancel()
        self._assert_result(Result.CANCELLED)

    def test_4_waypoints_are_followed_and_the_one_in_the_bed_is_missed(self):
        goal = Pose2(2.0, 0.3, 0.0)
        self.robot.follow_waypoints([(1.0, 0.2, 0.0), BED, (goal.x, goal.y, goal.yaw)], timeout=60.0)
        outcome = self._assert_result(Result.FAILED)
        self.assertEqual(outcome.missed, (1,))
        self.assertIn("waypoint 1: Failed to find a valid plan", outcome.reason)
        error = self.referee.truth.distance_to(goal)
        print(f"{outcome.reason}; {error:.3f} m off the last one")
        self.assertLess(error, 0.25)

    def test_5_time_outs_and_invalid_commands_have_an_outcome(self):
        self.robot.go_to(-4.0, -2.0, timeout=0.5)
        self._assert_result(Result.TIMED_OUT)
        self.robot.go_to(math.nan, 0.0)
        self._assert_result(Result.FAILED)
        self.robot.spin(1.0, speed=0.0)
        self._assert_result(Result.FAILED)
        with self.assertRaisesRegex(CommanderError, "no waypoints"):
            self.robot.follow_waypoints([])

    def test_6_costmaps_pose_and_map_are_set_or_the_reason_is_given(self):
        self.robot.clear_costmaps()
        here = self.robot.pose
        self.robot.set_initial_pose(here.x, here.y, here.yaw)
        with self.assertRaisesRegex(CommanderError, "there is no such map" if LoadMap else "no LoadMap"):
            self.robot.change_map("nowhere.yaml")
        self.assertEqual(self.referee.mission_record.collisions, [])

    def _assert_result(self, result):
        outcome = self.robot.wait(WALL_DEADLINE)
        self.assertIs(outcome.result, result, outcome.reason)
        wait_for_ground_truth(lambda: self.referee.simulated_time, WALL_DEADLINE)
        return outcome


if __name__ == "__main__":
    rospy.init_node("test_commander")
    rostest.rosrun("home_service_tests", "commander", CommanderTest)
