#!/usr/bin/env python3
"""Topics, frames and rates of the node sim_bridge."""

import math
import threading
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from recording import MessageRecorder
from rosgraph_msgs.msg import Clock, Log
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker
from waiting import wait_until

from planar_ros.messages.conversion import LaserScanArrays
from planar_ros.messages.transforms import Transforms


def periods(messages):
    return np.diff([message.header.stamp.to_sec() for message in messages])


class TestSimBridge(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.odom = MessageRecorder("odom", Odometry)
        cls.truth = MessageRecorder("base_pose_ground_truth", Odometry)
        cls.scan = MessageRecorder("scan", LaserScanArrays)
        cls.joints = MessageRecorder("joint_states", JointState)
        cls.clock = MessageRecorder("/clock", Clock)
        cls.tf = MessageRecorder("/tf", TFMessage)
        cls.contacts = MessageRecorder("contacts", String)
        cls.real_time_factor = MessageRecorder("sim_bridge/real_time_factor", Float64)
        cls.transforms = Transforms()
        cls.commands = {
            topic: rospy.Publisher(topic, Twist, queue_size=1)
            for topic in ("cmd_vel", "mobile_base/commands/velocity")
        }
        cls.boxes = rospy.Publisher("sim_bridge/add_box", Marker, queue_size=1)
        wait_until("scans", lambda: cls.scan.messages)
        publishers = (*cls.commands.values(), cls.boxes)
        wait_until("the simulation", lambda: all(one.get_num_connections() for one in publishers))

    def drive(self, topic, v, omega):
        """Commands a speed for a period of the odometry, which is returned."""
        command = Twist()
        command.linear.x, command.angular.z = v, omega
        self.commands[topic].publish(command)
        return self.odom.next()

    def turn_by(self, topic):
        wait_until("a turn", lambda: abs(self.drive(topic, 0.0, 0.8).twist.twist.angular.z - 0.8) < 0.1)

    def test_every_topic_comes_at_its_rate_and_time_never_goes_back(self):
        self.assertTrue(np.allclose(periods(self.odom.following(50)), 0.02))
        self.assertTrue(np.allclose(periods(self.truth.following(50)), 0.02))
        self.assertTrue(np.allclose(periods(self.scan.following(10)), 0.1))
        self.assertTrue(np.allclose(periods(self.joints.following(10)), 0.1))
        times = [message.clock.to_sec() for message in self.clock.following(50)]
        self.assertTrue(np.allclose(np.diff(times), 0.02))

    def test_simulated_time_passes_at_the_speed_asked_for(self):
        wait_until("1.5 times real time", lambda: abs(self.real_time_factor.next().data - 1.5) < 0.25)

    def test_frames_are_those_of_a_turtlebot(self):
        odometry = self.odom.next()
        self.assertEqual((odometry.header.frame_id, odometry.child_frame_id), ("odom", "base_footprint"))
        self.assertGreater(odometry.pose.covariance[0], 0.0)
        truth = self.truth.next()
        self.assertEqual(truth.header.frame_id, "world")
        scan = self.scan.next()
        self.assertEqual(scan.header.frame_id, "laser")
        self.assertEqual(len(scan.ranges), 360)
        for frame in ("laser", "base_link", "wheel_left_link", "wheel_right_link", "caster_front_link"):
            wait_until("its transform", lambda frame=frame: self.transforms.lookup("odom", frame) is not None)

    def test_odom_to_base_footprint_is_sent_with_the_odometry(self):
        def parents():
            sent = [one for message in list(self.tf.messages) for one in message.transforms]
            return {one.header.frame_id for one in sent if one.child_frame_id == "base_footprint"}

        wait_until("its transform", parents)
        self.assertEqual(parents(), {"odom"})

    def test_both_command_topics_drive_the_robot_and_it_stops_without_commands(self):
        for topic in self.commands:
            self.turn_by(topic)
            wait_until("a stop", lambda: abs(self.odom.next().twist.twist.angular.z) < 0.05)

    def test_wheels_turn_in_joint_states(self):
        self.assertEqual(self.joints.next().name, ["wheel_left_joint", "wheel_right_joint"])

        def wheels_turn():
            self.drive("cmd_vel", 0.1, 0.0)
            return min(self.joints.messages[-1].velocity) > 1.0

        wait_until("both wheels to turn", wheels_turn)

    def test_a_command_that_is_not_a_number_stops_the_robot(self):
        self.turn_by("cmd_vel")
        for _ in range(25):
            odometry = self.drive("cmd_vel", math.nan, 0.8)
        self.assertAlmostEqual(odometry.twist.twist.angular.z, 0.0, delta=0.05)

    def test_an_added_box_is_seen_and_what_is_touched_is_named(self):
        box = Marker(type=Marker.CUBE, ns="crate")
        truth = self.truth.next()
        heading = 2.0 * math.atan2(truth.pose.pose.orientation.z, truth.pose.pose.orientation.w)
        box.pose.position.x = truth.pose.pose.position.x + 0.7 * math.cos(heading)
        box.pose.position.y = truth.pose.pose.position.y + 0.7 * math.sin(heading)
        box.pose.orientation = truth.pose.pose.orientation
        box.scale.x = box.scale.y = box.scale.z = 0.4
        self.boxes.publish(box)
        wait_until("the box in the scan", lambda: abs(self.scan.next().ranges[180] - 0.5) < 0.05)
        pushing = threading.Event()
        threading.Thread(target=self._push_until, args=(pushing,), daemon=True).start()
        try:
            wait_until(
                "the contact",
                lambda: any("crate::link" in message.data for message in self.contacts.messages),
            )
        finally:
            pushing.set()

    def test_an_invalid_box_is_refused_with_a_reason_and_time_goes_on(self):
        log = MessageRecorder("/rosout", Log)
        wait_until("the log", log.is_connected)
        for size, x, reason in (
            (1e30, 2.0, "a box needs positive lengths and a valid pose, got (1e+30,"),
            (math.nan, 2.0, "a box needs positive lengths and a valid pose, got (nan,"),
            (0.4, 1e308, "a pose at 1e+308, 0, 0 is out of range"),
        ):
            box = Marker(type=Marker.CUBE, ns="giant")
            box.pose.position.x, box.pose.orientation.w = x, 1.0
            box.scale.x = box.scale.y = box.scale.z = size
            self.boxes.publish(box)
            words = f"box not added: {'giant: ' if x < 1e30 else ''}{reason}"
            wait_until(words, lambda words=words: any(words in line.msg for line in log.messages))
        self.assertTrue(np.allclose(periods(self.odom.following(50)), 0.02))

    def _push_until(self, done):
        while not done.is_set():
            self.drive("cmd_vel", 0.4, 0.0)


if __name__ == "__main__":
    rospy.init_node("sim_bridge_topics")
    rostest.rosrun("home_service_tests", "sim_bridge_topics", TestSimBridge)
