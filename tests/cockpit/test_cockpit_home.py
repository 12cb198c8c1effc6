#!/usr/bin/env python3
"""The home driven from a page in a browser: goals, poses, by hand; judged by ground truth."""

import math
import os
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rosgraph
import rospy
import rostest
from browser import Browser
from gazebo_msgs.msg import ModelStates
from geometry_msgs.msg import PointStamped, PoseStamped, PoseWithCovarianceStamped, Twist
from nav_msgs.msg import Odometry
from seeing import pixel
from waiting import wait_until

from cockpit.process import FREE_PORT, CockpitProcess
from teleop_lite.teleop import RAMP

PICTURES = os.environ.get("COCKPIT_PICTURES")
TELEOP = "/cmd_vel_mux/input/teleop"
GOAL = (1.5, 0.3)
# Keys, and whither they drive: the signs of the velocities along x and to the left.
DIRECTIONS = (("i", 1, 0), ("u", 1, 1), ("o", 1, -1), ("j", 0, 1), ("l", 0, -1), ("m", -1, 0))
# How many lines high the label of a checkbox is.
LINES_OF = """(() => {{
    const label = [...document.querySelectorAll('label')].find((one) => one.textContent === '{}');
    const text = label.parentElement;
    return text.getBoundingClientRect().height / parseFloat(getComputedStyle(text).lineHeight);
}})()"""
# A pixel is some centimetres of the floor; the robot stops within 0.25 m of its goal.
POINTING, ARRIVAL = 0.1, 0.35


class CockpitHomeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.newest = {}
        for topic, kind in (
            ("/base_pose_ground_truth", Odometry),
            ("/move_base_simple/goal", PoseStamped),
            ("/initialpose", PoseWithCovarianceStamped),
            ("/clicked_point", PointStamped),
            (TELEOP, Twist),
            ("/gazebo/model_states", ModelStates),
        ):
            rospy.Subscriber(topic, kind, lambda message, topic=topic: cls.newest.update({topic: message}))
        cls.velocities = []
        rospy.Subscriber(TELEOP, Twist, cls.velocities.append)
        cls.folder = tempfile.mkdtemp()
        cls.cockpit = CockpitProcess(FREE_PORT, Path(cls.folder) / "cockpit.log")
        cls.browser = Browser()
        cls.page = cls.browser.open(cls.cockpit.url)
        cls.page.wait_for("/scan", "/map", "/amcl", seconds=90.0)
        wait_until("the truth", lambda: "/base_pose_ground_truth" in cls.newest, 60.0)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.cockpit.close()

    def tearDown(self):
        if PICTURES and self._testMethodName < "test_7":
            self.page.screenshot(Path(PICTURES) / f"home_{self._testMethodName}.png")

    def test_1_the_page_complains_of_nothing_and_asks_nobody_else(self):
        own = self.cockpit.url.partition("/?")[0]
        allowed = (own, own.replace("http", "ws"), f"blob:{own}", "data:")
        self.assertEqual([url for url in self.page.requests if not url.startswith(allowed)], [])
        self.assertEqual(self.page.errors, [])

    def test_1_without_a_graphics_card_it_draws_a_quarter_of_the_pixels(self):
        share = self.page.evaluate(
            "((canvas) => canvas.width / canvas.clientWidth)(document.querySelector('canvas[data-engine]'))"
        )
        self.assertAlmostEqual(share, 0.5, delta=0.01)

    def test_1_long_names_of_topics_are_on_one_line(self):
        for name in ("/map", "/move_base/global_costmap/costmap"):
            self.assertLess(self.page.evaluate(LINES_OF.format(name)), 1.5, name)

    def test_1_one_robot_needs_no_selector(self):
        self.page.click("Drive")
        self.page.wait_for("Cancel the goal")
        self.assertNotIn("Robot\n", self.page.text())
        self.assertIsNone(self.page.value_of("Robot"))
        self.page.click("View")

    def test_2_a_goal_that_is_clicked_is_reached(self):
        self.page.click("Drive")
        wait_until("a robot that takes goals", lambda: _subscribers("/move_base_simple/goal"), 60.0)
        self.aim("Nav Goal", "Press on the floor")
        self.page.click_at(*pixel(self.page, *GOAL))
        self.page.wait_for("goal sent")
        wait_until("the goal", lambda: "/move_base_simple/goal" in self.newest)
        goal = self.newest["/move_base_simple/goal"].pose.position
        self.assertLess(math.hypot(goal.x - GOAL[0], goal.y - GOAL[1]), POINTING)
        wait_until("the robot at the goal", lambda: self.distance_to(*GOAL) < ARRIVAL, 60.0)

    def test_3_a_pose_is_pressed_turned_and_released(self):
        self.aim("Pose Estimate", "Press where the robot is")
        wait_until(
            "standing", lambda: abs(self.newest["/base_pose_ground_truth"].twist.twist.linear.x) < 0.01
        )
        x, y = self.truth()
        self.page.drag(pixel(self.page, x, y), pixel(self.page, x, y + 1.0))
        self.page.wait_for("pose estimate sent")
        wait_until("the estimate", lambda: "/initialpose" in self.newest)
        pose = self.newest["/initialpose"].pose.pose
        self.assertLess(math.hypot(pose.position.x - x, pose.position.y - y), POINTING)
        yaw = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
        self.assertAlmostEqual(yaw, math.pi / 2.0, delta=0.2)

    def test_3_a_point_that_is_clicked_is_published(self):
        self.aim("Publish Point", "it is published")
        self.page.click_at(*pixel(self.page, *GOAL))
        self.page.wait_for("point published", "The mouse turns the camera.")
        wait_until("the point", lambda: "/clicked_point" in self.newest)
        point = self.newest["/clicked_point"].point
        self.assertLess(math.hypot(point.x - GOAL[0], point.y - GOAL[1]), POINTING)

    def test_4_a_box_is_dropped_where_it_was_clicked(self):
        self.aim("Drop a box", "a box is dropped there")
        self.page.click_at(*pixel(self.page, -0.5, 1.0))
        self.page.wait_for("dropped")
        wait_until("the box", lambda: self.box() is not None)
        self.assertLess(math.hypot(self.box().x + 0.5, self.box().y - 1.0), 0.2)

    def test_5_furniture_is_moved_to_where_it_was_pressed(self):
        self.page.choose("Model", "armchair")
        self.aim("Move the model", "Press the new position of the model")
        self.page.drag(pixel(self.page, -1.0, -3.2), pixel(self.page, -1.0, -2.2))
        self.page.wait_for("armchair moved to")
        wait_until("the armchair", lambda: self.place_of("armchair").y < -2.9)
        self.assertLess(math.hypot(self.place_of("armchair").x + 1.0, self.place_of("armchair").y + 3.2), 0.2)

    def test_6_a_button_drives_as_long_as_it_is_held(self):
        start = self.truth()
        self.page.hold("I forward", 2.0)
        self.assertGreater(self.distance_to(*start), 0.1)
        wait_until("rest", lambda: self.newest[TELEOP] == Twist())

    def test_7_a_key_drives_as_long_as_it_is_held(self):
        for key, forward, left in DIRECTIONS:
            self.page.hold_key(key, f"driving by {key}", lambda: self.drives(forward, left))  # noqa: B023
            wait_until("the robot to move", self.is_moving)
            self.page.release_key(key)
            self.wait_until_standing()

    def test_7_k_stops_without_a_ramp(self):
        self.page.hold_key("i", "driving", lambda: self.newest[TELEOP].linear.x > 8.0 * RAMP.v)
        self.page.release_key("i")
        del self.velocities[:-1]
        self.page.hold_key("k", "a stop", lambda: self.newest[TELEOP] == Twist())
        self.page.release_key("k")
        speeds = [velocity.linear.x for velocity in self.velocities]
        self.assertGreater(max(a - b for a, b in zip(speeds, speeds[1:])), 2.0 * RAMP.v)
        self.wait_until_standing()

    def test_7_letters_that_are_written_do_not_drive(self):
        del self.velocities[:]
        self.page.focus("Object")
        self.page.hold_key("i", "letters", lambda: "iii" in self.page.value_of("Object"))
        self.page.release_key("i")
        self.page.evaluate("document.activeElement.blur()")
        self.assertEqual([velocity for velocity in self.velocities if velocity != Twist()], [])

    def test_9_a_tab_that_is_closed_while_a_key_is_held_stops_the_robot(self):
        page = self.browser.open(self.cockpit.url)
        page.wait_for("/scan", "/amcl", seconds=60.0)
        page.hold_key("j", "turning", lambda: self.newest[TELEOP].angular.z > 0.2)
        page.close()
        wait_until("rest", lambda: self.newest[TELEOP] == Twist(), 3.0)
        self.wait_until_standing()

    def test_9_a_closed_tab_stops_the_robot(self):
        self.page.press("J turn left")
        wait_until("turning", lambda: self.newest[TELEOP].angular.z > 0.2)
        self.page.close()
        wait_until("rest", lambda: self.newest[TELEOP] == Twist(), 3.0)
        wait_until("the robot to stand", lambda: not self.is_moving(), 3.0)

    def test_9b_nothing_is_subscribed_while_nobody_looks(self):
        wait_until("silence", lambda: not self.topics_of_cockpit(), 10.0)
        page = self.browser.open(self.cockpit.url)
        wait_until("scans", lambda: "/scan" in self.topics_of_cockpit(), 30.0)
        page.close()
        wait_until("silence", lambda: not self.topics_of_cockpit(), 10.0)

    def aim(self, tool, hint):
        self.page.click(tool)
        self.page.wait_for(hint)

    def topics_of_cockpit(self):
        """The topics that it subscribes to, without /clock, as any node, and without the log."""
        _, subscribers, _ = rosgraph.Master("/test").getSystemState()
        found = {topic for topic, nodes in subscribers if any(node.startswith("/cockpit") for node in nodes)}
        return found - {"/clock", "/rosout"}

    def truth(self):
        position = self.newest["/base_pose_ground_truth"].pose.pose.position
        return position.x, position.y

    def drives(self, forward, left):
        """Whether the robot is commanded in that direction."""
        command = self.newest[TELEOP]
        return (np.sign(command.linear.x), np.sign(command.angular.z)) == (forward, left)

    def wait_until_standing(self):
        wait_until("rest", lambda: self.newest[TELEOP] == Twist())
        wait_until("the robot to stand", lambda: not self.is_moving())

    def is_moving(self):
        twist = self.newest["/base_pose_ground_truth"].twist.twist
        return max(abs(twist.linear.x), abs(twist.angular.z)) > 0.01

    def distance_to(self, x, y):
        own = self.truth()
        return math.hypot(own[0] - x, own[1] - y)

    def box(self):
        return self.place_of("box_of_cockpit")

    def place_of(self, model):
        states = self.newest["/gazebo/model_states"]
        places = [pose for name, pose in zip(states.name, states.pose) if name.startswith(model)]
        return places[0].position if places else None


def _subscribers(topic):
    return dict(rosgraph.Master("/test").getSystemState()[1]).get(topic)


if __name__ == "__main__":
    rospy.init_node("test_cockpit_home")
    rostest.rosrun("home_service_tests", "home_in_browser", CockpitHomeTest)
