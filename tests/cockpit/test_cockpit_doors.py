#!/usr/bin/env python3
"""A door and a drawer opened from a page in a browser; judged by the simulator."""

import os
import tempfile
import unittest
from pathlib import Path

import rospy
import rostest
from browser import Browser
from gazebo_msgs.srv import GetJointProperties
from waiting import wait_until

from cockpit.process import FREE_PORT, CockpitProcess

PICTURES = os.environ.get("COCKPIT_PICTURES")


class CockpitDoorsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cockpit = CockpitProcess(FREE_PORT, Path(tempfile.mkdtemp()) / "cockpit.log")
        cls.browser = Browser()
        cls.page = cls.browser.open(cls.cockpit.url)
        rospy.wait_for_service("/gazebo/get_joint_properties", 60.0)
        cls.ask = rospy.ServiceProxy("/gazebo/get_joint_properties", GetJointProperties)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.cockpit.close()

    def test_a_door_and_a_drawer_are_opened_and_shut(self):
        self.page.wait_for("View", "Drive", seconds=90.0)
        self.page.click("Drive")
        self.page.wait_for("Doors and drawers")
        self.assertAlmostEqual(self.position("doorway::hinge"), 0.0, delta=0.02)
        self.open("doorway: hinge", 80)
        wait_until("the door", lambda: abs(self.position("doorway::hinge") + 1.2) < 0.05)
        self.open("chest: rail", 60)
        wait_until("the drawer", lambda: abs(self.position("chest::rail") - 0.3) < 0.05)
        if PICTURES:
            self.page.screenshot(Path(PICTURES) / "doors.png")
        self.open("doorway: hinge", 0)
        wait_until("the door shut", lambda: abs(self.position("doorway::hinge")) < 0.05)
        self.assertEqual(self.page.errors, [])

    def open(self, hinge, percent):
        self.page.choose("Of", hinge)
        self.page.fill_in("Open, %", str(percent))

    def position(self, joint):
        return self.ask(joint).position[0]


if __name__ == "__main__":
    rospy.init_node("test_cockpit_doors")
    rostest.rosrun("home_service_tests", "doors_in_browser", CockpitDoorsTest)
