#!/usr/bin/env python3
"""A client that sends and cancels thousands of goals does not block other clients for long."""

import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from move_base_client import START_SECONDS, pose_at
from move_base_msgs.msg import MoveBaseAction, MoveBaseActionGoal, MoveBaseGoal
from waiting import wait_until

from planar_ros.calls.actions import goal_is_over, server_is_ready

GOALS = 24000
MAX_STATUSES = 40
SECONDS = 20.0


class TestGoalStorm(unittest.TestCase):
    def test_a_goal_after_a_storm_of_goals_is_reached_soon(self):
        client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        wait_until("move_base", lambda: server_is_ready(client), START_SECONDS)
        counts = []
        rospy.Subscriber(
            "move_base/status", GoalStatusArray, lambda array: counts.append(len(array.status_list))
        )
        goals = rospy.Publisher("move_base/goal", MoveBaseActionGoal, queue_size=GOALS)
        cancels = rospy.Publisher("move_base/cancel", GoalID, queue_size=GOALS)
        wait_until(
            "the subscribers of move_base",
            lambda: goals.get_num_connections() and cancels.get_num_connections(),
        )
        wait_until("time to begin", lambda: rospy.get_time() > 0.0)
        began_at = time.monotonic()
        for number in range(GOALS):
            goals.publish(self.goal(number))
            if number % 10 == 0:
                cancels.publish(GoalID(id=f"storm {number}"))
        sent_at = time.monotonic()
        client.send_goal(MoveBaseGoal(pose_at(1.0, 0.0)))
        wait_until("its end", lambda: goal_is_over(client), SECONDS)
        seconds = time.monotonic() - sent_at
        print(
            f"sent in {sent_at - began_at:.1f} s, at the goal {seconds:.1f} s later, {max(counts)} statuses"
        )
        self.assertEqual(client.get_state(), GoalStatus.SUCCEEDED, client.get_goal_status_text())
        self.assertLessEqual(max(counts), MAX_STATUSES)

    @staticmethod
    def goal(number):
        message = MoveBaseActionGoal(goal=MoveBaseGoal(pose_at(0.5, 0.001 * (number % 100))))
        # As clients do: a goal without a stamp gets the time at which it is processed.
        message.goal_id.stamp, message.goal_id.id = rospy.Time.now(), f"storm {number}"
        return message


if __name__ == "__main__":
    rospy.init_node("test_goal_storm")
    rostest.rosrun("home_service_tests", "goal_storm", TestGoalStorm)
