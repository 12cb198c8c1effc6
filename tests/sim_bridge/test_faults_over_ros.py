#!/usr/bin/env python3
"""Faults of a file, and faults added while the simulation runs."""

import unittest

import numpy as np
import rospy
import rostest
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from sim_bridge_msgs.srv import AddFault
from waiting import wait_until


def nearest_in(scan):
    return np.nanmin(scan.ranges)


def is_all_nan(scan):
    return np.isnan(scan.ranges).all()


class TestFaults(unittest.TestCase):
    def setUp(self):
        self.scans, self.odometry = [], []
        rospy.Subscriber("scan", LaserScan, self.scans.append, queue_size=100)
        rospy.Subscriber("odom", Odometry, self.odometry.append, queue_size=100)
        rospy.wait_for_service("sim_bridge/add_fault", 20.0)
        self.add_fault = rospy.ServiceProxy("sim_bridge/add_fault", AddFault)
        wait_until("scans and odometry", lambda: self.scans and self.odometry)

    def test_a_fault_of_the_file_lasts(self):
        usual = nearest_in(self.scans[-1])
        self.add_fault("scan_biased", 2.0, -0.5)  # makes up for that of the file
        self.wait_for_a_scan("without the bias", lambda scan: nearest_in(scan) < usual - 0.3)
        wait_until("it to be back", lambda: nearest_in(self.scans[-1]) > usual - 0.2)

    def test_an_added_fault_begins_and_ends(self):
        self.assertTrue(self.add_fault("scan_nan", 1.0, 0.0).success)
        self.wait_for_a_scan("with all ranges NaN", is_all_nan)
        wait_until("valid ranges", lambda: not is_all_nan(self.scans[-1]))

    def test_odometry_stops_and_resumes(self):
        self.assertTrue(self.add_fault("odometry_stopped", 2.0, 0.0).success)
        wait_until("a gap", lambda: self.longest_gap() > 1.5)

    def test_a_late_scan_has_the_stamp_of_its_measurement(self):
        ages = []
        rospy.Subscriber("scan", LaserScan, lambda scan: ages.append(self.age_of(scan)), queue_size=100)
        self.assertTrue(self.add_fault("scan_late", 3.0, 1.0).success)
        wait_until("late scans", lambda: any(0.9 < age < 1.5 for age in ages))
        wait_until("scans in time", lambda: ages[-1] < 0.5)

    def wait_for_a_scan(self, what, is_it):
        """Search all received scans: the scan may no longer be the last one."""
        wait_until(f"a scan {what}", lambda: any(map(is_it, self.scans)))

    def age_of(self, scan):
        return (self.odometry[-1].header.stamp - scan.header.stamp).to_sec()

    def longest_gap(self):
        stamps = [message.header.stamp.to_sec() for message in self.odometry]
        return max(np.diff(stamps), default=0.0)

    def test_an_invalid_fault_is_refused_with_a_reason(self):
        for fault, reason in (
            (("scan_nans", 0.0, 0.0), "there is no fault 'scan_nans' (did you mean \"scan_nan\"?)"),
            (("scan_biased", 0.0, 99.0), "strength must be from"),
            (("scan_nan", -1.0, 0.0), "seconds must not be negative"),
            (("scan_nan", float("nan"), 0.0), "seconds must not be negative"),
        ):
            answer = self.add_fault(*fault)
            self.assertFalse(answer.success)
            self.assertIn(reason, answer.message)


if __name__ == "__main__":
    rospy.init_node("test_faults")
    rostest.rosrun("home_service_tests", "faults", TestFaults)
