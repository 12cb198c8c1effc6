#!/usr/bin/env python3
"""ROS command line tools are available under their names, and they terminate."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import roslib.packages
import rostest

PUBLISHERS = ("robot_state_publisher", "state_publisher")


def rosrun(*words, folder=None):
    return subprocess.run(
        ["rosrun", *words],
        cwd=folder,
        timeout=40.0,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )


class RosToolsTest(unittest.TestCase):
    def test_view_frames_draws_the_tree(self):
        with tempfile.TemporaryDirectory() as folder:
            run = rosrun("tf", "view_frames", folder=folder)
            self.assertEqual(run.returncode, 0, run.stdout)
            self.assertIn("odom", Path(folder, "frames.gv").read_text())
            self.assertTrue(Path(folder, "frames.pdf").read_bytes().startswith(b"%PDF"))

    def test_dynparam_ends_without_a_server(self):
        run = rosrun("dynamic_reconfigure", "dynparam", "get", "/nobody")
        self.assertEqual(run.returncode, 1, run.stdout)
        self.assertIn("/nobody", run.stdout)

    def test_dynparam_ends_without_a_master(self):
        with mock.patch.dict(os.environ, ROS_MASTER_URI="http://127.0.0.1:1"):
            run = rosrun("dynamic_reconfigure", "dynparam", "list")
        self.assertEqual(run.returncode, 1, run.stdout)
        self.assertIn("no ROS master at http://127.0.0.1:1", run.stdout)

    def test_the_other_tools_of_a_fixed_package_are_found(self):
        self.assertIn("tf_echo", rosrun("tf", "tf_echo").stdout)

    def test_roslaunch_finds_topic_tools(self):
        for name in ("relay", "mux", "throttle"):
            self.assertTrue(roslib.packages.find_node("topic_tools", name), name)

    def test_robot_state_publisher_has_its_former_name_too(self):
        found = [roslib.packages.find_node("robot_state_publisher", name) for name in PUBLISHERS]
        self.assertEqual([Path(nodes[0]).name for nodes in found if nodes], list(PUBLISHERS))
        self.assertEqual(len({os.path.realpath(nodes[0]) for nodes in found}), 1)

    def test_a_custom_robot_can_use_the_turtlebots_macros(self):
        parts = "".join(
            f'<xacro:include filename="$(find {package})/urdf/{name}.urdf.xacro"/>'
            for package, name in (
                ("turtlebot_description", "turtlebot_common_library"),
                ("kobuki_description", "kobuki"),
                ("turtlebot_description", "stacks/hexagons"),
                ("turtlebot_description", "sensors/kinect"),
            )
        )
        robot = (
            f'<robot name="mine" xmlns:xacro="http://ros.org/wiki/xacro">{parts}<kobuki/>'
            '<stack_hexagons parent="base_link"/><sensor_kinect parent="base_link"/><link name="laser"/>'
            '<joint name="laser_joint" type="fixed"><parent link="plate_top_link"/><child link="laser"/>'
            "</joint></robot>"
        )
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "mine.urdf.xacro")
            path.write_text(robot)
            run = rosrun("xacro", "xacro", str(path))
        self.assertEqual(run.returncode, 0, run.stderr)
        for link in ("base_footprint", "wheel_left_link", "plate_top_link", "camera_depth_optical_frame"):
            self.assertIn(f'<link name="{link}"', run.stdout)

    def test_xacro_accepts_the_options_for_the_former_order(self):
        with tempfile.TemporaryDirectory() as folder:
            robot = Path(folder, "robot.xacro")
            robot.write_text('<robot name="robot"/>')
            for order in ("--oldorder", "--inorder"):
                run = rosrun("xacro", "xacro", order, str(robot))
                self.assertEqual(run.returncode, 0, run.stdout)
                self.assertIn('<robot name="robot"/>', run.stdout)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "ros_tools", RosToolsTest)
