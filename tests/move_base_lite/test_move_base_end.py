#!/usr/bin/env python3
"""move_base that is shut down while it drives: the robot stops, and the client gets a result."""

import math

import rosnode
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist
from move_base_client import MessageRecorder, MoveBaseTestCase, pose_at
from move_base_msgs.msg import MoveBaseActionResult

from planar_ros.calls.actions import KILLED_TEXT

STOPPING_DISTANCE = 0.3


class TestMoveBaseEnd(MoveBaseTestCase):
    def test_the_last_command_is_to_stop_and_the_goal_is_aborted(self):
        results = MessageRecorder("move_base/result", MoveBaseActionResult).connected()
        self.drive(pose_at(2.0, 3.0))
        rosnode.kill_nodes(["/move_base"])
        self.assertEqual(self.result_of(), (GoalStatus.ABORTED, KILLED_TEXT))
        self.wait_until(lambda: "/move_base" not in rosnode.get_node_names())
        self.assertEqual(self.commands.messages[-1], Twist())
        self.wait_until(lambda: abs(self.odometry.messages[-1].twist.twist.linear.x) < 0.01)
        self.assertLess(self.distance_since(results.wait().header.stamp), STOPPING_DISTANCE)

    def distance_since(self, stamp):
        """Distance between the poses at ``stamp`` and now [m]; odometry is matched by its stamps."""
        received = self.odometry.messages
        start = next(message for message in received if message.header.stamp >= stamp).pose.pose.position
        end = received[-1].pose.pose.position
        distance = math.hypot(end.x - start.x, end.y - start.y)
        print(f"came to rest {distance:.3f} m from where move_base ended")
        return distance

    def tearDown(self):
        """Skip the wait for rest: the node is gone."""


if __name__ == "__main__":
    rospy.init_node("test_move_base_end")
    rostest.rosrun("home_service_tests", "move_base_end", TestMoveBaseEnd)
