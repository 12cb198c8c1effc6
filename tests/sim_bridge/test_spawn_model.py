#!/usr/bin/env python3
"""The script spawn_model, and the functions that scripts import from gazebo_ros."""

import math
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import rospy
import rostest
from gazebo_msgs.srv import DeleteModel, GetModelState, GetPhysicsProperties
from geometry_msgs.msg import Pose
from std_srvs.srv import Empty
from waiting import PATIENCE_SECONDS, wait_until

from gazebo_ros.gazebo_interface import spawn_sdf_model_client

POST = """<?xml version='1.0'?><sdf version='1.6'><model name='any'><static>1</static>
<link name="l"><collision name="c"><geometry><cylinder><radius>0.1</radius><length>1</length></cylinder>
</geometry></collision></link></model></sdf>"""


def spawn_model(*options, stdin=""):
    """Return the exit code and the output of the script."""
    command = ["rosrun", "gazebo_ros", "spawn_model", *options]
    done = subprocess.run(
        command, input=stdin, capture_output=True, text=True, timeout=PATIENCE_SECONDS, check=False
    )
    return done.returncode, done.stdout + done.stderr


def state(name, frame=""):
    return rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)(name, frame)


def yaw_of(orientation):
    return 2.0 * math.atan2(orientation.z, orientation.w)


class TestSpawnModel(unittest.TestCase):
    def setUp(self):
        rospy.wait_for_service("/gazebo/delete_model", PATIENCE_SECONDS)

    def tearDown(self):
        rospy.ServiceProxy("/gazebo/delete_model", DeleteModel)("post")

    def test_unknown_arguments_are_named_and_ignored_as_in_kinetic(self):
        place = ("$", "-x", "-3.75", "-trimesh", "post.stl", "-y", "2")
        code, text = spawn_model("-sdf", "-stdin", "-model", "post", *place, stdin=POST)
        self.assertEqual(code, 0, text)
        self.assertIn("ignoring unknown arguments: $ -trimesh post.stl", text)
        self.assertAlmostEqual(state("post").pose.position.x, -3.75)
        self.assertAlmostEqual(state("post").pose.position.y, 2.0)

    def test_a_file_is_spawned_where_asked_for_and_time_passes_on(self):
        rospy.ServiceProxy("/gazebo/pause_physics", Empty)()
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "post.sdf"
            file.write_text(POST)
            place = ("-x", "2", "-y", "-1", "-z", "0.5", "-Y", "1.5", "-reference_frame", "world")
            code, text = spawn_model("-sdf", "-file", str(file), "-model", "post", *place, "-unpause")
        self.assertEqual(code, 0, text)
        self.assertIn("SpawnModel: Successfully spawned entity", text)
        pose = state("post").pose
        self.assertAlmostEqual(pose.position.x, 2.0)
        self.assertAlmostEqual(pose.position.y, -1.0)
        self.assertAlmostEqual(yaw_of(pose.orientation), 1.5, places=6)
        self.assertFalse(rospy.ServiceProxy("/gazebo/get_physics_properties", GetPhysicsProperties)().pause)

    def test_a_failure_is_reported_in_a_line_with_exit_code_1(self):
        self.assertTrue(spawn_sdf_model_client("post", POST, "", Pose(), "", "/gazebo"))
        self.assertFalse(spawn_sdf_model_client("post", POST, "", Pose(), "", "/gazebo"))
        for options, stdin, reason in (
            (("-stdin",), POST, "SpawnModel: Failure - entity already exists."),
            (("-file", "/nowhere.sdf"), "", "/nowhere.sdf: cannot be read"),
            (("-stdin", "-J", "hinge", "wide"), POST, "-J: could not convert string to float: 'wide'"),
        ):
            code, text = spawn_model("-sdf", *options, "-model", "post", stdin=stdin)
            self.assertEqual(code, 1, text)
            self.assertIn(reason, text)
            self.assertNotIn("Traceback", text)

    def test_a_bound_model_goes_when_the_command_is_interrupted(self):
        command = ["rosrun", "gazebo_ros", "spawn_model", "-sdf", "-stdin", "-model", "post"]
        command += ["-wait", "mobile_base", "-b"]
        with subprocess.Popen(command, stdin=subprocess.PIPE, text=True) as process:
            process.stdin.write(POST)
            process.stdin.close()
            wait_until("the post", lambda: state("post").success)
            process.send_signal(signal.SIGINT)
            wait_until("its end", lambda: process.poll() is not None)
        self.assertFalse(state("post").success)


if __name__ == "__main__":
    rospy.init_node("spawn_model_test")
    rostest.rosrun("home_service_tests", "spawn_model", TestSpawnModel)
