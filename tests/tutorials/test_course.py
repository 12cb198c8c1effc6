#!/usr/bin/env python3
"""The nodes of the ROS course work as its lessons describe."""

import contextlib
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rospkg
import rospy
import rostest
from learning_server.srv import IntPlus
from roslaunch.config import load_config_default
from std_srvs.srv import Empty, Trigger
from turtlesim.msg import Pose
from waiting import PATIENCE_SECONDS, wait_until

RADIUS = 0.5 / 0.2  # metres: of the circle that turtle_velocity_publisher drives


@contextlib.contextmanager
def running(package, node, *arguments):
    """Run a node; yields a function that returns its output until then."""
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(
            ["rosrun", package, node, *arguments], stdout=output, stderr=subprocess.STDOUT
        )

        def printed():
            output.seek(0)
            return output.read().decode()

        try:
            yield printed
        finally:
            process.terminate()
            process.wait(15.0)


def run(package, node, *arguments):
    """Exit code and output of a node that terminates."""
    done = subprocess.run(
        ["rosrun", package, node, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=40.0,
        check=False,
    )
    return done.returncode, done.stdout.decode()


def nodes_launched_by(package):
    """Each launch file of a package with each of its nodes."""
    for path in sorted(Path(rospkg.RosPack().get_path(package), "launch").glob("*.launch")):
        config = load_config_default([str(path)], None, verbose=False)
        assert not config.config_errors, path
        for node in config.nodes:
            yield path, node


class CourseTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_course")
        rospy.wait_for_service("/reset", 30.0)

    def setUp(self):
        rospy.ServiceProxy("/reset", Empty)()

    def pose(self):
        return rospy.wait_for_message("/turtle1/pose", Pose, PATIENCE_SECONDS)

    def test_the_velocity_publisher_drives_a_circle(self):
        positions_xy = []
        with running("learning_topic", "turtle_velocity_publisher.py"):
            wait_until("the turtle to move", lambda: self.pose().linear_velocity > 0.0)
            subscriber = rospy.Subscriber(
                "/turtle1/pose", Pose, lambda pose: positions_xy.append((pose.x, pose.y))
            )
            wait_until("poses", lambda: len(positions_xy) > 300)
            subscriber.unregister()
        x, y = np.array(positions_xy).T
        # Least squares circle through all positions: x^2 + y^2 = 2 a x + 2 b y + c.
        a, b, c = np.linalg.lstsq(np.column_stack((2 * x, 2 * y, np.ones_like(x))), x**2 + y**2, rcond=None)[
            0
        ]
        distances = np.hypot(x - a, y - b)
        print(f"radius {np.sqrt(c + a * a + b * b):.3f} m, largest deviation {np.ptp(distances):.4f} m")
        self.assertLess(np.abs(distances - RADIUS).max(), 0.05)

    def test_the_pose_subscriber_prints_where_the_turtle_is(self):
        with running("learning_topic", "turtle_pose_subscriber.py") as printed:
            wait_until("a printed pose", lambda: "turtle pose: x 5.54, y 5.54" in printed())

    def test_company_info_is_published_and_received(self):
        with running("learning_topic", "Information_subscriber.py") as printed, running(
            "learning_topic", "Information_publisher.py"
        ):
            wait_until("the company info", lambda: "company info: Home Service" in printed())

    def test_talker_and_listener_exist_in_both_packages(self):
        for package, suffix, expected in (
            ("rospy_tutorials", ".py", "I heard hello world"),
            ("roscpp_tutorials", "", "I heard: [hello world"),
        ):
            with running(package, f"listener{suffix}") as printed, running(package, f"talker{suffix}"):
                wait_until(expected, lambda: expected in printed())  # noqa: B023

    def test_a_launch_file_can_be_started_with_a_delay(self):
        code, output = run(
            "timed_roslaunch", "timed_roslaunch.sh", "0.5", "learning_launch", "1_nodes.launch", "--nodes"
        )
        self.assertEqual(code, 0, output)
        self.assertIn("/turtlesim", output)
        code, output = run("timed_roslaunch", "timed_roslaunch.sh", "1")
        self.assertEqual(code, 2, output)
        self.assertIn("usage:", output)

    def test_a_turtle_is_spawned_once(self):
        code, output = run("learning_server", "a_new_turtle.py")
        self.assertEqual(code, 0, output)
        self.assertIn("spawned: turtle2", output)
        code, output = run("learning_server", "a_new_turtle.py")
        self.assertEqual(code, 1)
        self.assertIn("no turtle", output)

    def test_each_call_of_turtle_command_toggles_whether_the_turtle_drives(self):
        with running("learning_server", "turtle_vel_command_server.py"):
            rospy.wait_for_service("/turtle_vel_command", 20.0)
            toggle = rospy.ServiceProxy("/turtle_vel_command", Trigger)
            for message, drives in (("driving", True), ("standing", False), ("driving", True)):
                answer = toggle()
                self.assertEqual((answer.success, answer.message), (True, message))
                wait_until(message, lambda: (self.pose().linear_velocity > 0.0) == drives)  # noqa: B023

    def test_5_and_6_are_11(self):
        with running("learning_server", "IntPlus_server.py"):
            rospy.wait_for_service("/Two_Int_Plus", 20.0)
            self.assertEqual(rospy.ServiceProxy("/Two_Int_Plus", IntPlus)(-3, 7).result, 4)
            code, output = run("learning_server", "IntPlus_client.py", "5", "6")
        self.assertEqual(code, 0, output)
        self.assertIn("5 + 6 = 11", output)

    def test_a_polygon_is_drawn_and_an_invalid_one_rejected(self):
        with running("learning_action", "draw_polygon_server.py"):
            code, output = run("learning_action", "draw_polygon_client.py", "4", "1.5")
            self.assertEqual(code, 0, output)
            self.assertIn("side 4", output)
            self.assertIn("6.0 m drawn", output)
            code, output = run("learning_action", "draw_polygon_client.py", "2")
            self.assertEqual(code, 1)
            self.assertIn("at least 3 sides", output)
        pose = self.pose()
        self.assertAlmostEqual(pose.x, 5.544, delta=0.01)
        self.assertAlmostEqual(pose.y, 5.544, delta=0.01)

    def test_the_launch_files_name_nodes_that_exist(self):
        for package in ("learning_launch", "turtle_tf", "turtle_tf2"):
            for path, node in nodes_launched_by(package):
                found = Path(rospkg.RosPack().get_path(node.package), "nodes", node.type)
                self.assertTrue(found.is_file(), f"{path}: {node.package} {node.type}")

    def test_the_tf_demos_use_no_package_of_the_course(self):
        for package in ("turtle_tf", "turtle_tf2"):
            used = {node.package for _, node in nodes_launched_by(package)}
            self.assertEqual(used, {package, "turtlesim"})

    def test_the_headers_of_turtlesim_are_on_the_include_path(self):
        folders = os.environ.get("CPLUS_INCLUDE_PATH", "").split(":")
        folders += ["/usr/include", "/opt/ros/noetic/include"]
        self.assertTrue(any(Path(folder, "turtlesim/Spawn.h").is_file() for folder in folders), folders)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "course", CourseTest)
