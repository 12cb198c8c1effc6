#!/usr/bin/env python3
"""Faults of a simulated robot are injected from a browser; judged by what the robot publishes."""

import os
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
from browser import Browser
from sensor_msgs.msg import LaserScan
from waiting import wait_until

from cockpit.process import FREE_PORT, CockpitProcess

PICTURES = os.environ.get("COCKPIT_PICTURES")
BIAS = -0.4


class CockpitFaultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scans = []
        rospy.Subscriber("/scan", LaserScan, cls.scans.append)
        cls.cockpit = CockpitProcess(FREE_PORT, Path(tempfile.mkdtemp()) / "cockpit.log", tool="faults")
        cls.browser = Browser()
        cls.page = cls.browser.open(cls.cockpit.url, 1400, 900)
        wait_until("scans", lambda: cls.scans, 60.0)
        cls.page.wait_for("The laser publishes nothing.", "Inject the fault", seconds=90.0)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.cockpit.close()

    def tearDown(self):
        self.assertEqual(self.page.errors, [])

    def test_a_fault_is_active_for_its_duration(self):
        self.page.choose("Kind", "scan_nan")
        self.page.wait_for("All ranges are NaN.")
        self.page.fill_in("Seconds", "4")
        self.page.click("Inject the fault")
        self.page.wait_for("scan_nan is active.", "Active fault")
        wait_until("a blind scan", lambda: self.is_blind())
        wait_until("it to be over on the page", lambda: "Active fault" not in self.page.text())
        wait_until("the robot to see again", lambda: not self.is_blind())

    def test_what_goes_wrong_for_ever_outlives_its_window(self):
        usual = self.nearest()
        self.page.choose("Kind", "scan_biased")
        self.page.wait_for("All ranges are too long. Usually 0.1 m, from -1 to 1.")
        self.page.fill_in("Seconds", "0")
        self.page.fill_in("Strength", str(BIAS))
        self.page.click("Inject the fault")
        wait_until("shorter beams", lambda: abs(self.nearest() - usual - BIAS) < 0.1)
        self.page.wait_for(f"{BIAS} m", "forever")
        if PICTURES:
            self.page.screenshot(Path(PICTURES) / "faults.png")
        self.page.click("Tools")
        self.page.tick("Faults")
        wait_until("the window to close", lambda: "Inject the fault" not in self.page.text())
        self.page.tick("Faults")
        self.page.wait_for("Inject the fault", f"{BIAS} m", "forever")

    def test_a_rejection_by_the_simulator_is_shown(self):
        self.page.choose("Kind", "wheel_weak")
        self.page.wait_for("The left wheel turns more slowly", "from 0 to 1.")
        self.page.fill_in("Strength", "7")
        self.page.click("Inject the fault")
        self.page.wait_for("strength must be from 0 to 1")

    def is_blind(self):
        return np.isnan(self.scans[-1].ranges).all()

    def nearest(self):
        return np.nanmin(self.scans[-1].ranges)


if __name__ == "__main__":
    rospy.init_node("test_cockpit_faults")
    rostest.rosrun("home_service_tests", "faults_in_browser", CockpitFaultsTest)
