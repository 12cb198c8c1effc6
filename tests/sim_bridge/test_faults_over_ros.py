#!/usr/bin/env python3
"""What goes wrong by a file, and what is asked to go wrong while the simulation runs."""

import unittest

import numpy as np
import rospy
import rostest
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from sim_bridge_msgs.srv import AddFault
from waiting import wait_until


class TestFaults(unittest.TestCase):
    def setUp(self):
        self.scans, self.odometry = [], []
        rospy.Subscriber("scan", LaserScan, self.scans.append, queue_size=100)
        rospy.Subscriber("odom", Odometry, self.odometry.append, queue_size=100)
        rospy.wait_for_service("sim_bridge/add_fault", 20.0)
        self.add_fault = rospy.ServiceProxy("sim_bridge/add_fault", AddFault)
        wait_until("a scan", lambda: self.scans)

    def test_a_fault_of_the_file_lasts(self):
        nearest = np.nanmin(self.scans[-1].ranges)
        self.add_fault("scan_biased", 2.0, -0.5)  # makes up for that of the file
        wait_until("the bias to go", lambda: np.nanmin(self.scans[-1].ranges) < nearest - 0.3)
        wait_until("it to be back", lambda: np.nanmin(self.scans[-1].ranges) > nearest - 0.2)

    def test_a_fault_begins_when_asked_for_and_ends(self):
        self.assertTrue(self.add_fault("scan_nan", 1.0, 0.0).success)
        wait_until("a blind scan", lambda: np.isnan(self.scans[-1].ranges).all())
        wait_until("to see again", lambda: not np.isnan(self.scans[-1].ranges).all())

    def test_odometry_falls_silent_and_speaks_again(self):
        self.assertTrue(self.add_fault("odometry_stopped", 2.0, 0.0).success)
        wait_until("a gap", lambda: self.longest_gap() > 1.5)

    def test_a_late_scan_bears_the_stamp_of_its_measurement(self):
        self.assertTrue(self.add_fault("scan_late", 3.0, 1.0).success)
        wait_until("late scans", lambda: 0.9 < self.age_of_scan() < 1.5)
        wait_until("scans in time", lambda: self.age_of_scan() < 0.5)

    def age_of_scan(self):
        return (self.odometry[-1].header.stamp - self.scans[-1].header.stamp).to_sec()

    def longest_gap(self):
        stamps = [message.header.stamp.to_sec() for message in self.odometry]
        return max(np.diff(stamps), default=0.0)

    def test_what_makes_no_sense_is_refused_in_a_sentence(self):
        for asked, said in (
            (("scan_nans", 0.0, 0.0), "there is no fault 'scan_nans', did you mean scan_nan?"),
            (("scan_biased", 0.0, 99.0), "strength must be from"),
            (("scan_nan", -1.0, 0.0), "seconds must not be negative"),
            (("scan_nan", float("nan"), 0.0), "seconds must not be negative"),
        ):
            answer = self.add_fault(*asked)
            self.assertFalse(answer.success)
            self.assertIn(said, answer.message)


if __name__ == "__main__":
    rospy.init_node("test_faults")
    rostest.rosrun("home_service_tests", "faults", TestFaults)
