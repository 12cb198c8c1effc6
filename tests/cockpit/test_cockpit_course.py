#!/usr/bin/env python3
"""The course's turtles in the browser, and its rqt tools, each started by its own name."""

import math
import os
import unittest
from pathlib import Path

import rospy
import rostest
from browser import Browser
from command import Command
from turtlesim.msg import Pose
from waiting import wait_until

PICTURES = os.environ.get("COCKPIT_PICTURES")
NEAR, FAR = 0.5, 2.0


class CockpitCourseTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.newest = {}
        for name in ("turtle1", "turtle2"):
            rospy.Subscriber(f"/{name}/pose", Pose, lambda pose, name=name: cls.newest.update({name: pose}))
        wait_until("two turtles", lambda: len(cls.newest) == 2, 60.0)
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()

    def test_a_turtle_is_driven_at_the_page_and_the_other_one_follows(self):
        wait_until("both together", lambda: self.apart() < NEAR, 60.0)
        with Looking(self, "rqt_gui") as page:
            page.wait_for("/turtlesim/markers")
            page.click("Drive")
            page.choose("Velocities to", "/turtle1/cmd_vel")
            page.evaluate("document.activeElement.blur()")
            start = self.newest["turtle1"]
            page.hold_key("i", "the turtle to go", lambda: distance(start, self.newest["turtle1"]) > FAR)
            page.release_key("i")
        wait_until("both together again", lambda: self.apart() < NEAR, 60.0)

    def test_rqt_graph_draws_who_talks_to_whom(self):
        with Looking(self, "rqt_graph") as page:
            page.wait_for("/turtlesim", "/turtle1_tf_broadcaster", "/turtle_tf_listener", "/turtle2/cmd_vel")

    def test_rqt_plot_draws_where_a_turtle_is(self):
        with Looking(self, "rqt_plot", "/turtle2/pose/x") as page:
            page.wait_for("/turtle2/pose/x")
            wait_until("a chart", lambda: page.evaluate("document.querySelectorAll('.uplot').length") == 1)

    def test_rqt_console_lists_log_messages(self):
        with Looking(self, "rqt_console") as page:
            rospy.logwarn("a word of the test")
            page.wait_for("a word of the test")

    def test_rqt_logger_level_knows_the_nodes(self):
        with Looking(self, "rqt_logger_level") as page:
            page.click("Logger levels")
            page.choose("Of node", "/turtlesim")

    def test_rqt_tf_tree_draws_the_frames(self):
        with Looking(self, "rqt_tf_tree") as page:
            page.wait_for("world", "turtle1", "turtle2", "/turtle1_tf_broadcaster")

    def test_rqt_topic_shows_rates_and_values(self):
        with Looking(self, "rqt_topic") as page:
            page.choose("Watch", "/turtle1/pose")
            page.wait_for("linear_velocity: ")

    def test_rqt_publisher_drives_a_turtle(self):
        with Looking(self, "rqt_publisher") as page:
            page.fill_in("Topic", "/turtle1/cmd_vel")
            page.click("Create the message")
            wait_until("the template", lambda: "angular" in (page.value_of("Message") or ""))
            page.fill_in("Message", "angular: {z: 1.0}")
            before = self.newest["turtle1"].theta
            page.click("Publish once")
            wait_until("the turtle to turn", lambda: self.newest["turtle1"].theta != before)

    def test_rqt_service_caller_calls_a_turtle_home(self):
        with Looking(
            self, "rqt_service_caller", "rosrun", "rqt_service_caller", "rqt_service_caller"
        ) as page:
            page.choose("Service", "/turtle1/teleport_absolute")
            wait_until("the template", lambda: "theta" in (page.value_of("Request") or ""))
            page.fill_in("Request", "{x: 9.0, y: 8.0, theta: 0.0}")
            page.click("Call")
            wait_until("the turtle there", lambda: math.hypot(*place(self.newest["turtle1"])) > 12.0)

    def apart(self):
        return distance(*self.newest.values())


class Looking:
    """What a program of rqt shows in the browser."""

    def __init__(self, test, name, *words):
        self._test, self._name = test, name
        self._command = Command("rosrun", name, name, *words)

    def __enter__(self):
        self._page = self._test.browser.open(self._command.url, 1400, 900)
        self._page.wait_for("Tools", "View", seconds=60.0)
        return self._page

    def __exit__(self, kind, *_):
        with self._command:
            if PICTURES:
                self._page.screenshot(Path(PICTURES) / f"{self._name}.png")
            errors = list(self._page.errors)
            self._page.close()
            code = self._command.end()
        if kind is None:
            self._test.assertEqual((errors, code), ([], 0), "".join(self._command.lines))


def place(pose):
    return pose.x, pose.y


def distance(one, other):
    return math.dist(place(one), place(other))


if __name__ == "__main__":
    rospy.init_node("test_cockpit_course")
    rostest.rosrun("home_service_tests", "course_in_browser", CockpitCourseTest)
