#!/usr/bin/env python3
"""turtle2 follows turtle1, and reaches each of its positions within ten seconds."""

import math
import time
import unittest

import rospy
import rostest
from turtlesim.msg import Pose
from turtlesim.srv import TeleportAbsolute
from waiting import wait_until

NEAR, IN_TIME = 0.5, 10.0


class TfDemoTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_tf_demo")
        cls.poses = {}
        for turtle in ("turtle1", "turtle2"):
            rospy.Subscriber(
                f"/{turtle}/pose", Pose, lambda pose, name=turtle: cls.poses.update({name: pose})
            )
        wait_until("two turtles", lambda: len(cls.poses) == 2, 30.0)

    def distance(self):
        first, second = self.poses["turtle1"], self.poses["turtle2"]
        return math.hypot(first.x - second.x, first.y - second.y)

    def assert_followed_to(self, x, y):
        rospy.ServiceProxy("/turtle1/teleport_absolute", TeleportAbsolute)(x, y, 0.0)
        start, second = time.monotonic(), self.poses["turtle2"]
        distance = math.hypot(x - second.x, y - second.y)
        self.assertGreater(distance, NEAR)
        wait_until("turtle1 there", lambda: abs(self.poses["turtle1"].x - x) < 0.01)
        while self.distance() > NEAR:
            self.assertLess(time.monotonic() - start, IN_TIME, f"still {self.distance():.2f} m apart")
            time.sleep(0.05)
        print(f"{distance:.2f} m apart, within {NEAR} m after {time.monotonic() - start:.1f} s")

    def test_turtle2_comes_to_turtle1_and_after_it(self):
        self.assert_followed_to(2.0, 2.0)
        self.assert_followed_to(9.0, 8.0)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "tf_demo", TfDemoTest)
