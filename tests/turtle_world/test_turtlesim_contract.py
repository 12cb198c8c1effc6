#!/usr/bin/env python3
"""The node has turtlesim's topics, services, parameters and responses."""

import math
import os
import pty
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import rospy
import rostest
from geometry_msgs.msg import Twist
from PIL import Image
from std_srvs.srv import Empty
from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative
from visualization_msgs.msg import MarkerArray
from waiting import PATIENCE_SECONDS

MIDDLE, FLOOR_SIDE = 5.544445, 11.088889
# Number of consecutive poses from which the rate is measured.
POSES = 120
# Those of the official package.
MD5_SUMS = {
    Color: "353891e354491c51aabe32df673fb446",
    Pose: "863b248d5016ca62ea2e895ae5265cf9",
    Kill: "c1f3d28f1b044c871e6eff2e9fc3c667",
    SetPen: "9f452acce566bf0c0954594f69a8e41b",
    Spawn: "0b2d2e872a8e2887d5ed626f2bf2c561",
    TeleportAbsolute: "a130bc60ee6513855dc62ea83fcc5b20",
    TeleportRelative: "9d5c2dcd348ac8f76ce2a4307bd63a13",
}


def wait_until(is_so, seconds=PATIENCE_SECONDS):
    """Whether the condition occurs in time."""
    deadline = time.monotonic() + seconds
    while not is_so():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.02)
    return True


class TurtlesimContractTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_turtlesim_contract")
        rospy.wait_for_service("/reset", 30.0)

    def setUp(self):
        rospy.ServiceProxy("/reset", Empty)()
        # The topics of turtle1 are new ones: a publisher from before would still count its old connection.
        self.cmd_vel = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=1)
        self.addCleanup(self.cmd_vel.unregister)
        self.assertTrue(wait_until(lambda: self.cmd_vel.get_num_connections() > 0))

    def pose(self, turtle="turtle1"):
        return rospy.wait_for_message(f"/{turtle}/pose", Pose, PATIENCE_SECONDS)

    def color(self):
        color = rospy.wait_for_message("/turtle1/color_sensor", Color, PATIENCE_SECONDS)
        return color.r, color.g, color.b

    def publish_velocity(self, forward=0.0, turn=0.0):
        twist = Twist()
        twist.linear.x, twist.angular.z = forward, turn
        self.cmd_vel.publish(twist)

    def test_a_pose_that_is_not_finite_is_rejected(self):
        teleport = rospy.ServiceProxy("/turtle1/teleport_absolute", TeleportAbsolute)
        for x, theta in ((math.nan, 0.0), (math.inf, 0.0), (1.0, math.nan)):
            with self.assertRaisesRegex(rospy.ServiceException, "with invalid"):
                teleport(x, 1.0, theta)
        self.publish_velocity(forward=math.nan)
        teleport(1.0, 2.0, 0.5)
        self.assertTrue(wait_until(lambda: abs(self.pose().x - 1.0) < 0.01), "the world is still stepped")

    def test_messages_have_the_official_md5_sums(self):
        for kind, md5_sum in MD5_SUMS.items():
            self.assertEqual(kind._md5sum, md5_sum, kind._type)

    def test_turtle1_stands_in_the_middle_of_a_blue_floor(self):
        pose = self.pose()
        self.assertAlmostEqual(pose.x, MIDDLE, places=4)
        self.assertAlmostEqual(pose.y, MIDDLE, places=4)
        self.assertEqual((pose.theta, pose.linear_velocity), (0.0, 0.0))
        self.assertEqual(self.color(), (69, 86, 255))
        self.assertEqual([rospy.get_param("/turtlesim/background_" + c) for c in "rgb"], [69, 86, 255])

    def test_poses_come_at_about_62_hz(self):
        stamps = []

        def rate_of_late():
            latest = stamps[-POSES:]
            rate = (POSES - 1) / (latest[-1] - latest[0]) if len(latest) == POSES else 0.0
            return abs(rate - 62.5) < 6.0

        subscriber = rospy.Subscriber("/turtle1/pose", Pose, lambda _: stamps.append(time.monotonic()))
        # a machine that is busy lets them come late, but not all the time
        self.assertTrue(wait_until(rate_of_late))
        subscriber.unregister()

    def test_a_command_lasts_one_second(self):
        velocities = []
        subscriber = rospy.Subscriber(
            "/turtle1/pose", Pose, lambda pose: velocities.append(pose.linear_velocity), queue_size=1000
        )
        self.addCleanup(subscriber.unregister)
        self.assertTrue(wait_until(lambda: velocities))
        self.publish_velocity(forward=1.0)
        self.assertTrue(wait_until(lambda: 1.0 in velocities))
        self.assertTrue(wait_until(lambda: velocities[-1] == 0.0))
        self.assertAlmostEqual(self.pose().x, MIDDLE + 1.0, delta=0.05)

    def test_a_wall_stops_the_turtle(self):
        rospy.ServiceProxy("/turtle1/teleport_absolute", TeleportAbsolute)(FLOOR_SIDE - 0.3, 2.0, 0.0)
        self.publish_velocity(forward=2.0)
        self.assertTrue(wait_until(lambda: self.pose().x > FLOOR_SIDE - 0.02))
        time.sleep(0.5)
        self.assertLessEqual(self.pose().x, FLOOR_SIDE + 1e-4)

    def test_speeds_that_are_not_finite_are_ignored(self):
        self.publish_velocity(forward=math.nan)
        self.publish_velocity(turn=math.inf)
        time.sleep(0.3)
        self.assertAlmostEqual(self.pose().x, MIDDLE, places=4)

    def test_turtles_are_spawned_under_a_name_or_the_next_free_one_and_killed(self):
        spawn, kill = rospy.ServiceProxy("/spawn", Spawn), rospy.ServiceProxy("/kill", Kill)
        self.assertEqual(spawn(1.0, 2.0, 0.5, "").name, "turtle2")
        self.assertEqual(spawn(3.0, 3.0, 0.0, "leo").name, "leo")
        self.assertAlmostEqual(self.pose("turtle2").theta, 0.5, places=4)
        with self.assertRaises(rospy.ServiceException):
            spawn(1.0, 1.0, 0.0, "leo")
        kill("leo")
        with self.assertRaises(rospy.ServiceException):
            kill("leo")
        self.assertTrue(
            wait_until(lambda: "/leo/pose" not in [topic for topic, _ in rospy.get_published_topics()])
        )

    def test_the_pen_draws_what_the_colour_sensor_sees(self):
        rospy.ServiceProxy("/turtle1/set_pen", SetPen)(200, 100, 50, 5, 0)
        rospy.ServiceProxy("/turtle1/teleport_relative", TeleportRelative)(2.0, math.pi / 2)
        self.assertTrue(wait_until(lambda: self.color() == (200, 100, 50)))
        pose = self.pose()
        self.assertAlmostEqual(pose.y, MIDDLE + 2.0, places=3)
        rospy.ServiceProxy("/clear", Empty)()
        self.assertTrue(wait_until(lambda: self.color() == (69, 86, 255)))

    def test_a_lifted_pen_draws_nothing(self):
        rospy.ServiceProxy("/turtle1/set_pen", SetPen)(0, 0, 0, 0, 1)
        rospy.ServiceProxy("/turtle1/teleport_relative", TeleportRelative)(2.0, 0.0)
        self.assertEqual(self.color(), (69, 86, 255))

    def test_rviz_can_see_turtles_and_strokes(self):
        rospy.ServiceProxy("/turtle1/teleport_relative", TeleportRelative)(2.0, 1.0)
        markers = rospy.wait_for_message("/turtlesim/markers", MarkerArray, PATIENCE_SECONDS).markers
        self.assertLessEqual({"floor", "turtles", "strokes"}, {marker.ns for marker in markers})

    def test_the_arrow_keys_drive_turtle1(self):
        keyboard, terminal = pty.openpty()
        teleop = subprocess.Popen(["rosrun", "turtlesim", "turtle_teleop_key"], stdin=terminal)
        try:
            self.assertTrue(wait_until(lambda: self.cmd_vel_publishers() > 1, 20.0))

            def drives():
                os.write(keyboard, b"\x1b[A")  # lost, as long as turtlesim has not connected
                return self.pose().x > MIDDLE + 1.0

            self.assertTrue(wait_until(drives))
            os.write(keyboard, b"q")
            self.assertEqual(teleop.wait(PATIENCE_SECONDS), 0)
        finally:
            teleop.kill()
            teleop.wait()

    def cmd_vel_publishers(self):
        publishers, _, _ = rospy.get_master().getSystemState()[2]
        return len(dict(publishers).get("/turtle1/cmd_vel", ()))

    def test_the_picture_is_what_the_window_would_show(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "turtles.png"
            command = ["rosrun", "turtlesim", "turtlesim_node", "--picture", str(picture)]
            node = subprocess.Popen([*command, "__name:=painter", "__ns:=paint"])
            try:
                rospy.wait_for_service("/paint/turtle1/teleport_absolute", 20.0)
                rospy.ServiceProxy("/paint/turtle1/set_pen", SetPen)(250, 0, 0, 4, 0)
                rospy.ServiceProxy("/paint/turtle1/teleport_absolute", TeleportAbsolute)(9.0, 9.0, 0.0)
                node.send_signal(signal.SIGINT)
                node.wait(PATIENCE_SECONDS)
            finally:
                node.kill()
                node.wait()
            with Image.open(picture) as image:
                self.assertEqual(image.size, (500, 500))
                self.assertIn((250, 0, 0), [color for _, color in image.convert("RGB").getcolors(1000)])

    def test_a_picture_that_cannot_be_written_ends_the_node_with_a_reason(self):
        command = [
            "rosrun",
            "turtlesim",
            "turtlesim_node",
            "--picture",
            "/nowhere/turtles.png",
            "__name:=other",
        ]
        done = subprocess.run(command, capture_output=True, timeout=30.0, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("/nowhere/turtles.png", done.stderr.decode())
        self.assertNotIn("Traceback", done.stderr.decode())


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "turtlesim_contract", TurtlesimContractTest)
