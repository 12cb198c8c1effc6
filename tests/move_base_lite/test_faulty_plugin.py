#!/usr/bin/env python3
"""A local planner that breaks its contract: the robot stops, the log names it, the node keeps running."""

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from custom_planners.misbehaving import CREEP, FAULTS_BY_GOAL
from fake_robot import FakeRobot
from geometry_msgs.msg import Twist
from move_base_client import MessageRecorder, MoveBaseTestCase, pose_at
from move_base_msgs.msg import MoveBaseGoal
from rosgraph_msgs.msg import Log

MESSAGES = {
    "raises": "raised ZeroDivisionError: division by zero",
    "answers NaN": "asked for nan m/s",
    "rushes": "asked for 100 m/s",
    "dawdles": r"took [2-9]\.\d s for an answer",
    "scribbles": "raised ValueError: assignment destination is read-only",
}
AHEAD = 2.0


class TestFaultyPlugin(MoveBaseTestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = FakeRobot()
        rospy.sleep(2.0)  # simulated time has begun
        cls.robot.show_map()
        super().setUpClass()
        cls.log = MessageRecorder("rosout", Log)

    def send(self, y):
        """Send a goal; return how many commands there were before."""
        before = len(self.commands.messages)
        self.client.send_goal(MoveBaseGoal(pose_at(AHEAD, y)))
        return before

    def assert_creeps(self):
        before = self.send(2.0)
        self.wait_until(lambda: any(sent.linear.x == CREEP for sent in self.commands.messages[before:]))
        self.client.cancel_goal()

    def assert_is_named(self, y, fault):
        before = self.send(y)
        state, text = self.result_of()
        self.assertEqual(state, GoalStatus.ABORTED, text)
        self.assertRegex(
            text, rf"\[code=PLUGIN_FAILED: custom_planners\.misbehaving/MisbehavingPlanner {MESSAGES[fault]}"
        )
        self.wait_until(lambda: any(text == entry.msg for entry in self.log.messages))
        fastest = max((abs(sent.linear.x) for sent in self.commands.messages[before:]), default=0.0)
        # The first call may take longer, as numba compiles kernels in it.
        self.assertLessEqual(fastest, CREEP if fault == "dawdles" else 0.0, fault)

    def test_each_fault_is_reported_while_the_robot_stands_and_the_next_goal_is_executed(self):
        for y, fault in FAULTS_BY_GOAL.items():
            self.assert_creeps()
            self.wait_until(lambda: not self.has_active_goal())
            self.wait_until(lambda: self.commands.messages[-1] == Twist())
            self.assert_is_named(y, fault)
        self.assert_creeps()


if __name__ == "__main__":
    rospy.init_node("test_faulty_plugin")
    rostest.rosrun("home_service_tests", "faulty_plugin", TestFaultyPlugin)
