#!/usr/bin/env python3
"""The graph on two hosts: simulator and robot on one, the rest on the other, with a link that fails."""

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
# Time-out of velocity commands, and time to brake and to publish it, simulated [s].
COMMAND_SECONDS, BRAKING_SECONDS = 0.6, 0.6
DISCONNECTED_SECONDS = 5.0
STANDING, DRIVING = 0.01, 0.1  # m/s
START_SECONDS, RESTART_SECONDS, ERRAND_SECONDS = 60.0, 40.0, 90.0


@unittest.skipUnless(os.geteuid() == 0, "only root can make network namespaces")
class TwoHostsTest(unittest.TestCase):
    def setUp(self):
        self._condition = threading.Condition()
        self._truths, self._states = [], []

    def test_an_errand_survives_a_disconnected_link(self):
        with NetworkLink() as link:
            link.robot.start(link.robot, "rosmaster", "--core")
            self.enter(link)
            world = f"world_file:={ROOT / 'map' / 'home.world'}"
            link.robot.start(link.robot, "roslaunch", "home_service", "world.launch", world)
            self.subscribe()
            # The robot's side first: it sets the run id and use_sim_time.
            self.wait_until(lambda: self._truths, START_SECONDS, "no simulator")
            files = (f"map_file:={ROOT / 'map' / 'home.yaml'}", f"zones_file:={HERE / 'zones.yaml'}")
            link.desk.start(link.robot, "roslaunch", "home_service", "desk.launch", *files)
            try:
                self.watch(link)
            finally:
                rospy.signal_shutdown("done")

    def enter(self, link):
        """Move this process to the robot's host."""
        os.environ.update(link.robot.environment(link.robot))
        link.robot.enter()
        self.wait_until(rosgraph.is_master_online, START_SECONDS, "no master")

    def subscribe(self):
        rospy.init_node("test_two_hosts", disable_signals=True)
        rospy.Subscriber("base_pose_ground_truth", Odometry, self.keep_truth, queue_size=10)
        rospy.Subscriber("pick_objects/state", String, self.keep_state, queue_size=10)

    def watch(self, link):
        self.wait_until(lambda: self.speed() > DRIVING, START_SECONDS, "the robot does not start")
        for node in ON_DESK:
            self.assertEqual(self.host_of(node), link.desk.address, node)
        self.assertEqual(self.host_of("/sim_bridge"), link.robot.address)

        link.disconnect()
        disconnected_at = self.now()
        self.wait_until(lambda: self.standing_since(disconnected_at), 10.0, "the robot does not stop")
        stopped_after = self.standing_since(disconnected_at) - disconnected_at
        time.sleep(DISCONNECTED_SECONDS)
        self.assertLess(self.speed(), STANDING)
        print(f"stopped {stopped_after:.2f} s of simulated time after the disconnection")
        self.assertLess(stopped_after, COMMAND_SECONDS + BRAKING_SECONDS)

        link.reconnect()
        reconnected_at = time.monotonic()
        self.wait_until(lambda: self.speed() > DRIVING, RESTART_SECONDS, "the robot does not continue")
        print(f"driving again {time.monotonic() - reconnected_at:.1f} s after the link was reconnected")
        ends = ("delivered", "failed")
        self.wait_until(lambda: self._states[-1:] and self._states[-1] in ends, ERRAND_SECONDS, "no end")
        self.assertEqual(self._states[-1], "delivered")

    def keep_truth(self, message):
        with self._condition:
            self._truths.append(message)
            self._condition.notify_all()

    def keep_state(self, message):
        with self._condition:
            self._states.append(message.data)
            self._condition.notify_all()

    def speed(self):
        return speed_in(self._truths[-1]) if self._truths else 0.0

    def standing_since(self, stamp):
        """Stamp of the first standstill from a stamp on [s]; None if there is none."""
        standing = (stamp_of(truth) for truth in self._truths if speed_in(truth) < STANDING)
        return next((each for each in standing if each >= stamp), None)

    def now(self):
        return stamp_of(self._truths[-1])

    def host_of(self, node):
        uri = rosgraph.Master("/test_two_hosts").lookupNode(node)
        return urlparse(uri).hostname

    def wait_until(self, is_so, seconds, what):
        deadline = time.monotonic() + seconds
        with self._condition:
            while not is_so():
                self.assertLess(time.monotonic(), deadline, f"{what}; states {self._states}")
                self._condition.wait(0.1)


def stamp_of(truth):
    return truth.header.stamp.to_sec()


def speed_in(truth):
    """Speed of the robot [m/s]; rotation counts as the speed of its rim."""
    twist = truth.twist.twist
    return math.hypot(twist.linear.x, twist.linear.y) + 0.18 * abs(twist.angular.z)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "two_hosts", TwoHostsTest)
