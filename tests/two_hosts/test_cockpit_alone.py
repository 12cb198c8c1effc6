#!/usr/bin/env python3
"""The cockpit on a machine without network: cockpit, ROS graph and browser have only the loopback."""

import os
import sys
import tempfile
import unittest
from pathlib import Path

import rosgraph
import rostest
from browser import Browser
from network import IsolatedHost, routes_of
from waiting import wait_until

from cockpit.process import FREE_PORT, CockpitProcess

STAGE = Path(__file__).resolve().parents[1] / "cockpit" / "stage.py"
PICTURES = os.environ.get("COCKPIT_PICTURES")
START_SECONDS = 60.0
IS_DRAWN = "[...document.querySelectorAll('canvas')].some((one) => one.width > 100 && one.height > 100)"


@unittest.skipUnless(os.geteuid() == 0, "only root can make network namespaces")
class CockpitAloneTest(unittest.TestCase):
    def test_the_cockpit_works_without_any_route(self):
        with tempfile.TemporaryDirectory() as folder, IsolatedHost() as isolated:
            isolated.start(isolated, "rosmaster", "--core")
            os.environ.update(isolated.environment(isolated))
            isolated.enter()  # with its children, the cockpit and the browser
            self.assertEqual(routes_of(isolated), "")
            wait_until("a master", rosgraph.is_master_online, START_SECONDS)
            isolated.start(isolated, sys.executable, str(STAGE))
            cockpit = CockpitProcess(FREE_PORT, Path(folder) / "cockpit.log", tool="topics")
            try:
                with Browser() as browser:
                    self.check_page(browser.open(cockpit.url), cockpit.url.partition("/?")[0])
            finally:
                cockpit.close()

    def check_page(self, page, own):
        page.wait_for("View", "Drive", "Tools", "/camera/image", "std_msgs/Float64", seconds=START_SECONDS)
        page.choose("Watch", "/sine")
        page.wait_for("data: ")
        wait_until("the world", lambda: page.evaluate(IS_DRAWN))
        if PICTURES:
            page.screenshot(Path(PICTURES) / "alone.png")
        allowed = (own, own.replace("http", "ws"), f"blob:{own}", "data:")
        self.assertEqual([url for url in page.requests if not url.startswith(allowed)], [])
        self.assertEqual(page.errors, [])


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "cockpit_alone", CockpitAloneTest)
