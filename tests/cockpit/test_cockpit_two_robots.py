#!/usr/bin/env python3
"""Two robots on one page: each is sent by a click, and arrives by ground truth."""

import os
import tempfile
import unittest
from pathlib import Path

import rospy
import rostest
from browser import Browser
from nav_msgs.msg import Odometry
from seeing import pixel
from waiting import wait_until

from cockpit.process import FREE_PORT, CockpitProcess
from planar import Pose2
from planar_ros.messages.conversion import pose2_from_msg

PICTURES = os.environ.get("COCKPIT_PICTURES")
GOALS = {"alice": Pose2(1.0, 0.3, 0.0), "bob": Pose2(2.0, 3.0, 0.0)}
# A pixel is some centimetres of the floor; a robot stops within 0.25 m of its goal.
ARRIVAL, DRIVE_SECONDS = 0.35, 120.0


class CockpitTwoRobotsTest(unittest.TestCase):
    def setUp(self):
        self.truth = {}
        for name in GOALS:
            topic = f"/{name}/base_pose_ground_truth"
            rospy.Subscriber(topic, Odometry, lambda message, name=name: self.truth.update({name: message}))
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.cockpit = CockpitProcess(FREE_PORT, Path(folder.name) / "cockpit.log")
        self.addCleanup(self.cockpit.close)
        self.browser = Browser()
        self.addCleanup(self.browser.close)

    def test_each_is_sent_by_a_click_and_arrives(self):
        page = self.browser.open(self.cockpit.url, 1400, 1100)
        page.wait_for("/map", "/alice/scan", "/bob/scan", seconds=120.0)
        wait_until("both robots", lambda: len(self.truth) == len(GOALS), 60.0)
        # Clicks into the picture are complained of by viser's own camera control.
        self.assertEqual(page.errors, [])
        page.click("Drive")
        for name, goal in GOALS.items():
            page.choose("Robot", name)
            page.click("Nav Goal")
            page.wait_for("Press on the floor")
            page.click_at(*pixel(page, goal.x, goal.y))
            wait_until(f"{name} to set off", lambda: self.speed_of(name) > 0.1, 60.0)  # noqa: B023
        if PICTURES:
            page.click("View")
            page.screenshot(Path(PICTURES) / "two_robots.png")
        for name, goal in GOALS.items():
            wait_until(f"{name} at its goal", lambda: self.has_arrived(name, goal), DRIVE_SECONDS)  # noqa: B023
            print(f"{name}: {self.place_of(name).distance_to(goal):.3f} m off")

    def has_arrived(self, name, goal):
        return self.place_of(name).distance_to(goal) < ARRIVAL and self.speed_of(name) < 0.01

    def place_of(self, name):
        return pose2_from_msg(self.truth[name].pose.pose)

    def speed_of(self, name):
        return abs(self.truth[name].twist.twist.linear.x)


if __name__ == "__main__":
    rospy.init_node("test_cockpit_two_robots")
    rostest.rosrun("home_service_tests", "two_robots_in_browser", CockpitTwoRobotsTest)
