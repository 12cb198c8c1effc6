#!/usr/bin/env python3
"""Lock-step by progress reports: the simulation waits for nodes that process its data."""

import time
import unittest

import rospy
import rostest
from recording import is_connected_to_all
from rosgraph_msgs.msg import Log
from std_msgs.msg import Float64
from waiting import wait_until

from planar_ros.lockstep.ticker import ProgressPublisher
from planar_ros.messages.conversion import LaserScanArrays

PERIOD = 0.1


class TestLockStep(unittest.TestCase):
    def test_a_slow_node_loses_no_scan_and_a_silent_one_is_given_up(self):
        progress, stamps, factors, ahead = ProgressPublisher(), [], [], []
        working = True

        def work(scan):
            stamps.append(scan.header.stamp.to_sec())
            if working:
                time.sleep(0.02)
                ahead.append(rospy.get_time() - stamps[-1])
                progress.report(scan.header.stamp)

        rospy.Subscriber("scan", LaserScanArrays, work, queue_size=100, tcp_nodelay=True)
        rospy.Subscriber("sim_bridge/real_time_factor", Float64, lambda message: factors.append(message.data))
        wait_until("scans", lambda: len(stamps) > 50, 25.0)
        wait_until("more than real time", lambda: max(factors, default=0.0) > 1.5, 25.0)
        gaps = [later - earlier for earlier, later in zip(stamps, stamps[1:])]
        self.assertLess(max(gaps), PERIOD + 1e-6)
        self.assertLess(max(ahead[10:]), PERIOD + 1e-6, "but for the first, which start the lock-step")

        logged = []
        log = rospy.Subscriber("/rosout", Log, lambda line: logged.append((line.name, line.msg)))
        wait_until("the log", lambda: is_connected_to_all(log))
        working = False
        count = len(stamps)
        wait_until("more scans", lambda: len(stamps) > count + 20, 25.0)
        warning = "no progress of lock_step: the simulation goes on without it in real time"
        wait_until("the name of the silent node", lambda: ("/sim_bridge", warning) in logged)


if __name__ == "__main__":
    rospy.init_node("lock_step")
    rostest.rosrun("home_service_tests", "lock_step", TestLockStep)
