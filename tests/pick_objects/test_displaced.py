#!/usr/bin/env python3
"""A robot that is driven away or reset while it picks up returns, and picks up where it should."""

import time
import unittest

import actionlib
import rospy
import rostest
from geometry_msgs.msg import Twist
from home_service_msgs.msg import DeliverAction, DeliverGoal
from std_msgs.msg import String
from std_srvs.srv import Empty

from evaluation.consumers.referee import Referee
from evaluation.ros.run_topics import observe
from planar_ros.calls.actions import server_is_ready

WALL_DEADLINE = 80.0
MISSION = """\
places:
  hall: {x: 1.2, y: 0.2}
  door: {x: 2.2, y: 0.2}
settings: {pickup_seconds: 8.0, retry_seconds: 0.5}
deliveries:
  - {name: cup, object: cup, from: hall, to: door}
"""


class DisplacedTest(unittest.TestCase):
    def setUp(self):
        self.remarks = []
        rospy.Subscriber("/simulation/remarks", String, lambda message: self.remarks.append(message.data))
        self.referee = Referee({}, print)
        observe(self.referee)
        client = actionlib.SimpleActionClient("deliver", DeliverAction)
        self._wait("the robot", lambda: server_is_ready(client) and self.referee.truth)
        client.send_goal(DeliverGoal(mission=MISSION))
        self._wait("the pick-up", lambda: self._state() == "picking up")

    def test_1_driven_away_by_velocity_commands_of_another_node(self):
        commands = rospy.Publisher("mobile_base/commands/velocity", Twist, queue_size=1)
        command = Twist()
        command.linear.x = -0.5

        def is_away():
            commands.publish(command)
            return self._state() != "picking up"

        self._wait("the robot to be away", is_away)
        self._assert_delivered()

    def test_2_reset(self):
        rospy.ServiceProxy("/gazebo/reset_simulation", Empty)()
        self._wait("the robot to be reset", lambda: self._state() != "picking up")
        self._assert_delivered()
        self.assertIn("/gazebo/reset_simulation was called by /displaced", self.remarks[-1])

    def _assert_delivered(self):
        self._wait("the end", lambda: self._state() in ("delivered", "failed"))
        record = self.referee.mission_record.deliveries[-1]
        print(f"attempts {record.attempts}, {record.pickup_error:.3f} m, {record.dropoff_error:.3f} m")
        self.assertLess(record.pickup_error, 0.25)
        self.assertGreater(record.attempts, 2)
        self.assertIsNone(record.failure)

    def _state(self):
        deliveries = self.referee.mission_record.deliveries
        return deliveries[-1].state if deliveries else ""

    def _wait(self, what, is_there):
        deadline = time.monotonic() + WALL_DEADLINE
        while not is_there():
            self.assertLess(time.monotonic(), deadline, f"no sign of {what}")
            time.sleep(0.02)


if __name__ == "__main__":
    rospy.init_node("displaced_test")
    rostest.rosrun("home_service_tests", "displaced", DisplacedTest)
