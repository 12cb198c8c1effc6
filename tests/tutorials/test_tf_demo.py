#!/usr/bin/env python3
"""turtle2 follows turtle1: it is there within ten seconds, and again after turtle1 has gone elsewhere."""

import math
import time
import unittest

import rospy
import rostest
from turtlesim.msg import Pose
from turtlesim.srv import TeleportAbsolute

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
        deadline = time.monotonic() + 30.0
        while len(cls.poses) < 2:
            assert time.monotonic() < deadline, "there are no two turtles"
            time.sleep(0.02)

    def distance(self):
        first, second = self.poses["turtle1"], self.poses["turtle2"]
        return math.hypot(first.x - second.x, first.y - second.y)

    def assert_reached(self):
        start, distance = time.monotonic(), self.distance()
        self.assertGreater(distance, NEAR)
        while self.distance() > NEAR:
            self.assertLess(time.monotonic() - start, IN_TIME, f"still {self.distance():.2f} m apart")
            time.sleep(0.05)
        print(f"{distance:.2f} m apart, within {NEAR} m after {time.monotonic() - start:.1f} s")

    def test_turtle2_comes_to_turtle1_and_after_it(self):
        self.assert_reached()
        rospy.ServiceProxy("/turtle1/teleport_absolute", TeleportAbsolute)(9.0, 8.0, 0.0)
        time.sleep(0.2)
        self.assert_reached()


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "tf_demo", TfDemoTest)
