#!/usr/bin/env python3
"""A world that changes: a door and a drawer opened from a page in a browser, models that come and go."""

import os
import tempfile
import unittest
from pathlib import Path

import rospy
import rostest
from browser import Browser
from gazebo_msgs.srv import DeleteModel, GetJointProperties, SpawnModel
from geometry_msgs.msg import Point, Pose, Quaternion
from page_client import PageClient
from waiting import wait_until

from cockpit.process import FREE_PORT, CockpitProcess

PICTURES = os.environ.get("COCKPIT_PICTURES")
CUP = """<sdf version="1.6"><model name="cup"><link name="cup">
<inertial><mass>0.2</mass></inertial>
<collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
<visual name="v"><geometry><box><size>0.2 0.2 0.2</size></box></geometry>
<material><diffuse>0.8 0.1 0.1 1</diffuse></material></visual></link></model></sdf>"""


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

    def test_a_model_that_is_spawned_is_shown_until_it_is_deleted(self):
        rospy.wait_for_service("/gazebo/spawn_sdf_model", 60.0)
        with PageClient(self.cockpit.url) as client:

            def is_shown():
                return "/world/cup::cup" in client.nodes

            pose = Pose(Point(1.0, 0.5, 0.1), Quaternion(w=1.0))
            answer = rospy.ServiceProxy("/gazebo/spawn_sdf_model", SpawnModel)("cup", CUP, "", pose, "world")
            self.assertTrue(answer.success, answer.status_message)
            wait_until("the cup", is_shown, 30.0)
            if PICTURES:
                self.page.screenshot(Path(PICTURES) / "spawned.png")
            rospy.ServiceProxy("/gazebo/delete_model", DeleteModel)("cup")
            wait_until("no cup", lambda: not is_shown())

    def test_the_browser_takes_no_more_than_its_share_of_the_processor(self):
        self.page.wait_for("View", "Drive", seconds=90.0)
        self.assertGreaterEqual(min(self.browser.niceness()), 0)

    def open(self, hinge, percent):
        self.page.choose("Of", hinge)
        self.page.fill_in("Open, %", str(percent))

    def position(self, joint):
        return self.ask(joint).position[0]


if __name__ == "__main__":
    rospy.init_node("test_cockpit_doors")
    rostest.rosrun("home_service_tests", "doors_in_browser", CockpitDoorsTest)
