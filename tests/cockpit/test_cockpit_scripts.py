#!/usr/bin/env python3
"""Scripts with --web: mapping by hand, and a user's project."""

import os
import shutil
import tempfile
import unittest
import uuid
from pathlib import Path

import numpy as np
import rospy
import rostest
from browser import Browser
from command import URL, Command
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from page_client import PageClient
from projects import remove_work_folder
from waiting import wait_until

from planar import UNKNOWN, load_map

ROOT = Path(__file__).resolve().parents[2]
SAMPLE = ROOT / "tests/run_project/sample_project"
PICTURES = os.environ.get("COCKPIT_PICTURES")
MORE_AREA = 2.0  # m2


class CockpitScriptsTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.browser = Browser()
        self.addCleanup(self.browser.close)

    def test_a_map_is_made_by_hand(self):
        script = ROOT / "scripts/test_slam.sh"
        with Command(script, "--drive", "page", "--seed", "107", "--output", self.folder) as run:
            os.environ["ROS_MASTER_URI"] = run.wait_for_line("ROS_MASTER_URI=")
            robot = Robot()
            page = self.browser.open(run.url, 1400, 900)
            page.wait_for("/map", "/scan", seconds=90.0)
            wait_until("a map", lambda: robot.known_area > 0.0, 60.0)
            first = robot.known_area
            page.click("Drive")
            page.hold_key("l", "the robot to turn", lambda: robot.twist.angular.z < -0.1)
            page.hold_key("l", "more to be known", lambda: robot.known_area > first + MORE_AREA)
            page.release_key("l")
            wait_until("the robot to stand", lambda: abs(robot.twist.angular.z) < 0.01)
            print(f"{first:.1f} m2 known at first, {robot.known_area:.1f} m2 in the end")
            if PICTURES:
                page.screenshot(Path(PICTURES) / "mapping_by_hand.png")
            self.assertEqual(page.errors, [])
            page.close()
            self.assertEqual(run.end(), 0)
        grid = load_map(Path(run.wait_for_line("SUCCESS: map saved in ")))
        self.assertGreater((grid.cells != UNKNOWN).sum() * grid.resolution**2, first + MORE_AREA)

    def test_somebodys_project_is_looked_at(self):
        project = shutil.copytree(SAMPLE, self.folder / f"looked_at_{uuid.uuid4().hex}")
        self.addCleanup(remove_work_folder, project)
        script = ROOT / "scripts/run_project.sh"
        # Slow enough to be looked at by a browser that comes up on a busy machine.
        looked_at = ("--web", "--speed", "0.5", "--output", self.folder / "runs")
        with Command(script, project, *looked_at) as run:
            url = run.wait_for_line(URL, 300.0)
            with PageClient(url) as client:
                page = self.browser.open(url, 1400, 900)
                page.wait_for("/map", "/scan", "/visualization_marker", seconds=120.0)
                wait_until("its world", lambda: any("cupboard" in node for node in list(client.nodes)), 60.0)
            if PICTURES:
                page.screenshot(Path(PICTURES) / "project.png")
            self.assertEqual(page.errors, [])
            page.close()
            run.wait_for_line("SUCCESS: 2 of 2 goals reached", 180.0)


class Robot:
    """What it truly does, and how much of its world is known."""

    def __init__(self):
        rospy.init_node("looker_on", disable_signals=True)
        self.twist, self.known_area = Twist(), 0.0
        rospy.Subscriber("/base_pose_ground_truth", Odometry, self._on_truth)
        rospy.Subscriber("/map", OccupancyGrid, self._on_map)

    def _on_truth(self, message):
        self.twist = message.twist.twist

    def _on_map(self, message):
        known = np.count_nonzero(np.array(message.data, np.int8) != UNKNOWN)
        self.known_area = known * message.info.resolution**2


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "scripts_in_browser", CockpitScriptsTest)
