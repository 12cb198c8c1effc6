#!/usr/bin/env python3
"""A node that knows nothing of lock-step: simulated time waits until it rests, and does not wait for ever."""

import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from recording import is_connected_to_all
from rosgraph_msgs.msg import Log
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from waiting import wait_until

from planar_ros.messages.conversion import LaserScanArrays
from sim_bridge.ros.timing.paced_nodes import PACE_TOPIC

SCAN_PERIOD, WORK_SECONDS = 0.1, 0.02
GIVEN_UP = "paced_node has computed for 5 s without a pause: the simulation goes on in real time"


class TestPacedNode(unittest.TestCase):
    def test_time_keeps_pace_with_the_node_until_it_never_rests(self):
        check_pace(self)
        logged, stop = [], threading.Event()
        log = rospy.Subscriber("/rosout", Log, lambda line: logged.append((line.name, line.msg)))
        wait_until("the log", lambda: is_connected_to_all(log))
        threading.Thread(target=lambda: compute(60.0, stop), daemon=True).start()
        wait_until("the name of the node that never rests", lambda: ("/sim_bridge", GIVEN_UP) in logged, 30.0)
        stamp = rospy.get_time()
        wait_until("time to go on", lambda: rospy.get_time() > stamp + 2.0, 30.0)
        stop.set()


class TestPaceOfAll(unittest.TestCase):
    def test_time_keeps_pace_with_a_node_that_nobody_names(self):
        # A node to which nobody listens is waited for 0.5 s only, which a busy machine may take for its work.
        rospy.Publisher("cmd_vel", Twist, queue_size=1)
        check_pace(self)


def check_pace(test):
    """Check that simulated time waits for the work of this node on each scan."""
    stamps, ahead, sentences, transformed, untransformed = [], [], [], set(), []

    def work(scan):
        stamps.append(scan.header.stamp.to_sec())
        if scan.header.stamp not in transformed:
            untransformed.append(len(stamps) - 1)
        compute(WORK_SECONDS)
        ahead.append(rospy.get_time() - stamps[-1])

    rospy.Subscriber("/tf", TFMessage, lambda message: transformed.add(message.transforms[0].header.stamp))
    rospy.Subscriber("scan", LaserScanArrays, work, queue_size=1, tcp_nodelay=True)
    rospy.Subscriber(PACE_TOPIC, String, lambda message: sentences.append(message.data))
    wait_until("a rule for this node", lambda: any("paced_node:" in text for text in sentences), 60.0)
    first = len(stamps) + 1  # the work on the scan before may have begun before the rule
    wait_until("scans", lambda: len(stamps) > first + 100, 60.0)
    gaps = [later - earlier for earlier, later in zip(stamps[first:], stamps[first + 1 :])]
    test.assertLess(max(gaps), SCAN_PERIOD + 1e-6, "the node misses no scan although it keeps only one")
    # Filters of tf2_ros lose a scan whose transform arrives while they add it.
    test.assertFalse([i for i in untransformed if i > first], "the transform of a scan comes before it")
    # In real time, the clock would be ahead by the time of the work.
    test.assertLess(max(ahead[first:]), -1e-6, "the clock shows the time of a scan after the work on it")


def compute(seconds, stop=threading.Event()):
    """Compute for a time, or until it is stopped."""
    end = time.monotonic() + seconds
    while time.monotonic() < end and not stop.is_set():
        pass


if __name__ == "__main__":
    rospy.init_node("paced_node")
    paces_all = rospy.get_param("/sim_bridge/pace_all", False)
    rostest.rosrun("home_service_tests", "paced_node", TestPaceOfAll if paces_all else TestPacedNode)
