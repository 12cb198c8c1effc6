#!/usr/bin/env python3
"""A respawned explorer with ``autostart``: its checkpoint belongs to the exploration that it starts."""

import os
import signal
import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from home_service_msgs.msg import ExploreAction, ExploreActionResult, ExploreGoal
from processes import node_pid
from test_explore import HALF_KNOWN, START, ToyWorld
from waiting import wait_until

from planar import Pose2
from planar_ros.calls.actions import goal_is_over, server_is_ready

ELSEWHERE = Pose2(2.25, 1.75)


class AutostartTest(unittest.TestCase):
    def test_later_goals_have_their_own_start_and_a_finished_exploration_is_not_repeated(self):
        results = []
        rospy.Subscriber("explore/result", ExploreActionResult, results.append)
        world = ToyWorld()
        world.reset("succeeds")
        wait_until("the exploration", lambda: results)
        self.assertEqual(results[0].status.status, GoalStatus.SUCCEEDED)
        self.assertLess(world.robot.distance_to(START), 0.01)
        client = actionlib.SimpleActionClient("explore", ExploreAction)
        wait_until("the action", lambda: server_is_ready(client))
        world.robot = ELSEWHERE
        world.show(HALF_KNOWN)
        time.sleep(1.0)  # the explorer's map and transform are the new ones
        client.send_goal(ExploreGoal(return_to_start=True))
        wait_until("the result", lambda: goal_is_over(client))
        self.assertEqual(client.get_state(), GoalStatus.SUCCEEDED)
        self.assertLess(world.robot.distance_to(ELSEWHERE), 0.01)
        pid = node_pid("/explore")
        os.kill(pid, signal.SIGKILL)
        wait_until("another process", lambda: node_pid("/explore") not in (None, pid))
        world.show(HALF_KNOWN)
        wait_until("the action", lambda: server_is_ready(client))
        time.sleep(3.0)
        self.assertEqual(len(results), 2)
        self.assertLess(world.robot.distance_to(ELSEWHERE), 0.01)


if __name__ == "__main__":
    rospy.init_node("test_autostart")
    rostest.rosrun("home_service_tests", "autostart", AutostartTest)
