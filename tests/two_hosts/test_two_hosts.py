#!/usr/bin/env python3
"""The graph on two hosts: simulator and robot on one, the rest on the other; then the cable is cut."""

import math
import os
import threading
import time
import unittest
from pathlib import Path
from urllib.parse import urlparse

import rosgraph
import rospy
import rostest
from nav_msgs.msg import Odometry
from network import NetworkLink
from std_msgs.msg import String

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
ON_DESK = ("/map_server", "/amcl", "/move_base", "/pick_objects", "/add_markers")
# The robot's time-out of commands, simulated seconds, and what it takes to brake and to tell.
COMMAND_SECONDS, BRAKING_SECONDS = 0.6, 0.6
CUT_SECONDS = 5.0
STANDING, DRIVING = 0.01, 0.1  # m/s
START_SECONDS, RESTART_SECONDS, ERRAND_SECONDS = 60.0, 40.0, 90.0


@unittest.skipUnless(os.geteuid() == 0, "only root can make network namespaces")
class TwoHostsTest(unittest.TestCase):
    def setUp(self):
        self._news = threading.Condition()
        self._seen, self._states = [], []

    def test_an_errand_survives_a_cut_cable(self):
        with NetworkLink() as link:
            link.robot.start(link.robot, "rosmaster", "--core")
            self.enter(link)
            world = f"world_file:={ROOT / 'map' / 'home.world'}"
            link.robot.start(link.robot, "roslaunch", "home_service", "world.launch", world)
            self.listen()
            # The robot's side first: it says whose run this is, and that time is simulated.
            self.wait_until(lambda: self._seen, START_SECONDS, "no simulator")
            files = (f"map_file:={ROOT / 'map' / 'home.yaml'}", f"zones_file:={HERE / 'zones.yaml'}")
            link.desk.start(link.robot, "roslaunch", "home_service", "desk.launch", *files)
            try:
                self.watch(link)
            finally:
                rospy.signal_shutdown("done")

    def enter(self, link):
        """From here on this process is on the robot's host."""
        os.environ.update(link.robot.environment(link.robot))
        link.robot.enter()
        self.wait_until(rosgraph.is_master_online, START_SECONDS, "no master")

    def listen(self):
        rospy.init_node("test_two_hosts", disable_signals=True)
        rospy.Subscriber("base_pose_ground_truth", Odometry, self.keep_truth, queue_size=10)
        rospy.Subscriber("pick_objects/state", String, self.keep_state, queue_size=10)

    def watch(self, link):
        self.wait_until(lambda: self.speed() > DRIVING, START_SECONDS, "the robot does not start")
        for node in ON_DESK:
            self.assertEqual(self.host_of(node), link.desk.address, node)
        self.assertEqual(self.host_of("/sim_bridge"), link.robot.address)

        link.disconnect()
        cut_at = self.now()
        self.wait_until(lambda: self.standing_since(cut_at), 10.0, "the robot drives on without commands")
        stopped_after = self.standing_since(cut_at) - cut_at
        time.sleep(CUT_SECONDS)
        self.assertLess(self.speed(), STANDING)
        print(f"stopped {stopped_after:.2f} s of simulated time after the cut")
        self.assertLess(stopped_after, COMMAND_SECONDS + BRAKING_SECONDS)

        link.reconnect()
        reconnected_at = time.monotonic()
        self.wait_until(lambda: self.speed() > DRIVING, RESTART_SECONDS, "the robot does not drive on")
        print(f"driving again {time.monotonic() - reconnected_at:.1f} s after the cable was mended")
        ends = ("delivered", "failed")
        self.wait_until(lambda: self._states[-1:] and self._states[-1] in ends, ERRAND_SECONDS, "no end")
        self.assertEqual(self._states[-1], "delivered")

    def keep_truth(self, message):
        with self._news:
            self._seen.append(message)
            self._news.notify_all()

    def keep_state(self, message):
        with self._news:
            self._states.append(message.data)
            self._news.notify_all()

    def speed(self):
        return speed_in(self._seen[-1]) if self._seen else 0.0

    def standing_since(self, stamp):
        """The first moment from a stamp on at which the robot stands, also seconds; None if there is none."""
        standing = (stamp_of(seen) for seen in self._seen if speed_in(seen) < STANDING)
        return next((each for each in standing if each >= stamp), None)

    def now(self):
        return stamp_of(self._seen[-1])

    def host_of(self, node):
        uri = rosgraph.Master("/test_two_hosts").lookupNode(node)
        return urlparse(uri).hostname

    def wait_until(self, is_so, seconds, what):
        deadline = time.monotonic() + seconds
        with self._news:
            while not is_so():
                self.assertLess(time.monotonic(), deadline, f"{what}; states {self._states}")
                self._news.wait(0.1)


def stamp_of(truth):
    return truth.header.stamp.to_sec()


def speed_in(truth):
    """Of the robot: m/s, and its turning as that of its rim."""
    twist = truth.twist.twist
    return math.hypot(twist.linear.x, twist.linear.y) + 0.18 * abs(twist.angular.z)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "two_hosts", TwoHostsTest)
