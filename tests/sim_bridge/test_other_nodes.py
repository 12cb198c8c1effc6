#!/usr/bin/env python3
"""Nodes that cannot be paced: the waits are bounded, a sentence names the node, time passes in real time."""

import subprocess
import sys
import time
import unittest
from contextlib import contextmanager

import rospy
import rostest
from recording import is_connected_to_all
from rosgraph_msgs.msg import Log
from std_msgs.msg import String
from waiting import wait_until

# Simulated seconds in a second of the wall clock: faster than real time, and real time.
FAST, REAL_TIME = 1.5, 1.1
NODE = """
import os, threading, time, rospy
from std_msgs.msg import String
def compute(seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        pass
rospy.init_node({name!r})
publisher = rospy.Publisher("answers", String, queue_size=1)
{work}
time.sleep(600)
"""
WORK = {
    "spinning": "time.sleep(3); compute(600)",
    "late": "time.sleep(3); compute(7)",
    "flooding": "time.sleep(3)\nwhile True: publisher.publish('answer')",
    "of_the_wall": "",
    "dying": "time.sleep(4); os._exit(0)",
    "silent": "",
}


class TestOtherNodes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.logged, cls.rules = [], []
        log = rospy.Subscriber("/rosout", Log, lambda line: cls.logged.append((line.name, line.msg)))
        rospy.Subscriber("/simulation/pace", String, lambda message: cls.rules.append(message.data))
        rospy.Subscriber("answers", String, lambda message: None)
        wait_until("the log", lambda: is_connected_to_all(log))

    def test_1_beside_a_node_that_floods_time_passes_in_real_time(self):
        with started("flooding"):
            self.expect("flooding: time waits until all its threads rest (rest: learned")
            self.expect("flooding has computed for 5 s without a pause: the simulation goes on in real time")
            self.check_real_time()
        self.check_faster_than_real_time()

    def test_2_a_node_that_is_late_once_is_waited_for_again(self):
        with started("late"):
            self.expect("late has computed for 5 s without a pause: the simulation goes on in real time")
            self.expect("late rests again: simulated time waits for it")
            self.check_faster_than_real_time()

    def test_3_beside_a_node_that_spins_for_ever_time_passes_in_real_time(self):
        with started("spinning"):
            self.expect("spinning has computed for 5 s without a pause: the simulation goes on in real time")
            self.check_real_time()

    def test_4_beside_a_node_that_ignores_the_clock_time_passes_in_real_time(self):
        rospy.set_param("/use_sim_time", False)
        with started("of_the_wall"):
            self.expect("of_the_wall: time passes in real time at most (real_time: it does not subscribe to")
            rospy.set_param("/use_sim_time", True)
            self.check_real_time()
        self.check_faster_than_real_time()

    def test_5_a_node_that_dies_is_named(self):
        with started("dying"):
            self.expect("dying: time waits until all its threads rest (rest: set by pace)")
            self.expect("dying has ended: the simulation goes on in real time")
            self.check_real_time()

    def test_6_a_node_that_never_answers_is_named(self):
        with started("silent"):
            self.expect("silent has sent nothing on /answers for 10 s: the simulation goes on in real time")
            self.check_real_time()
        self.assertIn("silent: time waits for its messages on /answers", self.rules[-1])

    def expect(self, text):
        """Wait until the simulator logs a text."""
        wait_until(
            text,
            lambda: any(name == "/sim_bridge" and text in line for name, line in list(self.logged)),
            60.0,
        )

    def check_faster_than_real_time(self):
        wait_until("more than real time", lambda: pace() > FAST, 60.0)

    def check_real_time(self):
        self.assertLess(pace(), REAL_TIME)
        self.assertGreater(pace(), 0.1, "it goes on")


@contextmanager
def started(name):
    """A node in a separate process."""
    process = subprocess.Popen([sys.executable, "-c", NODE.format(name=name, work=WORK[name])])
    try:
        yield
    finally:
        process.kill()
        process.wait()


def pace():
    """Simulated seconds in a second of the wall clock, for a while."""
    wall, stamp = time.monotonic(), rospy.get_time()
    time.sleep(1.5)
    return (rospy.get_time() - stamp) / (time.monotonic() - wall)


if __name__ == "__main__":
    rospy.init_node("other_nodes")
    rostest.rosrun("home_service_tests", "other_nodes", TestOtherNodes)
