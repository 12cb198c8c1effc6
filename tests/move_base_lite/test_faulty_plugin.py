#!/usr/bin/env python3
"""A local planner that does what none must: the robot stands, the log names it, the node goes on."""

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist
from move_base_client import MessageRecorder, MoveBaseTestCase, pose_at
from move_base_msgs.msg import MoveBaseGoal
from own_planners.moody import CREEP, MISDEEDS
from rosgraph_msgs.msg import Log
from stage import Stage

FAULTS = {
    "raises": "raised ZeroDivisionError: division by zero",
    "answers NaN": "asked for nan m/s",
    "rushes": "asked for 100 m/s",
    "dawdles": r"took [2-9]\.\d s for an answer",
    "scribbles": "changed what it was given to read",
}
AHEAD = 2.0


class TestFaultyPlugin(MoveBaseTestCase):
    @classmethod
    def setUpClass(cls):
        cls.stage = Stage()
        rospy.sleep(2.0)  # simulated time has begun
        cls.stage.show_map()
        super().setUpClass()
        cls.log = MessageRecorder("rosout", Log)

    def send(self, y):
        """How many commands had come before."""
        before = len(self.commands.messages)
        self.client.send_goal(MoveBaseGoal(pose_at(AHEAD, y)))
        return before

    def assert_creeps(self):
        before = self.send(2.0)
        self.wait_until(lambda: any(sent.linear.x == CREEP for sent in self.commands.messages[before:]))
        self.client.cancel_goal()

    def assert_is_named(self, y, misdeed):
        before = self.send(y)
        state, text = self.result_of()
        self.assertEqual(state, GoalStatus.ABORTED, text)
        self.assertRegex(text, rf"\[code=PLUGIN_FAILED: own_planners\.moody/Moody {FAULTS[misdeed]}")
        self.wait_until(lambda: any(text == told.msg for told in self.log.messages))
        fastest = max((abs(sent.linear.x) for sent in self.commands.messages[before:]), default=0.0)
        # The first answer may take its time, as kernels are compiled in it.
        self.assertLessEqual(fastest, CREEP if misdeed == "dawdles" else 0.0, misdeed)

    def test_each_misdeed_is_named_at_a_standstill_and_the_next_goal_is_pursued(self):
        for y, misdeed in MISDEEDS.items():
            self.assert_creeps()
            self.wait_until(lambda: not self.has_active_goal())
            self.wait_until(lambda: self.commands.messages[-1] == Twist())
            self.assert_is_named(y, misdeed)
        self.assert_creeps()


if __name__ == "__main__":
    rospy.init_node("test_faulty_plugin")
    rostest.rosrun("home_service_tests", "faulty_plugin", TestFaultyPlugin)
