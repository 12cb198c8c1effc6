#!/usr/bin/env python3
"""What passes through the relay: to the last bit as it came, or as the faults of file and service have it."""

import math
import subprocess
import tempfile
import unittest
from io import BytesIO
from pathlib import Path

import numpy as np
import roslib.packages
import rospy
import rostest
from geometry_msgs.msg import Twist, Vector3
from listening import Heard
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from sim_bridge_msgs.srv import AddFault
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage
from waiting import wait_until

NODE = roslib.packages.find_node("sim_bridge", "fault_relay")[0]
# What the clock shows first, and at the beginning of each test: when it goes back the faults begin anew.
FIRST = 100.0
# Of the file: from START to END it is blind, from LAST on all beams meet something at once.
START, END, LAST = FIRST + 10.0, FIRST + 20.0, FIRST + 30.0


def data_of(message):
    buffer = BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def scan_message(second=5, angle_min=-1.0):
    return LaserScan(
        header=Header(77, rospy.Time(second, 123456789), "/laser"), angle_min=angle_min, angle_max=1.0,
        angle_increment=0.5, time_increment=0.001, scan_time=0.1, range_min=0.1, range_max=math.inf,
        ranges=[1.0, math.inf, 2.5, math.nan, 0.75], intensities=[10.0, 0.0, 3.0, 4.0, 5.0],
    )  # fmt: skip


def odometry_message(x=2.0, seconds=5):
    message = Odometry(header=Header(77, rospy.Time(seconds, 123456789), "odom"), child_frame_id="base")
    message.pose.pose.position.x, message.pose.pose.position.z = x, 0.25
    message.pose.pose.orientation.w = 1.0
    message.pose.covariance = [float(number) for number in range(36)]
    message.twist.twist = command_message()
    return message


def command_message(v=0.4):
    return Twist(Vector3(v, 0.1, 0.2), Vector3(0.3, 0.4, 0.5))


class Passage:
    """Sends bytes on a topic and hears those on the other."""

    def __init__(self, topic, told, kind):
        self._kind = kind
        self._publisher = rospy.Publisher(topic, kind, queue_size=100)
        self._heard = Heard(told, rospy.AnyMsg)
        wait_until(f"a relay of {topic}", lambda: self._publisher.get_num_connections() > 0)
        wait_until(f"a relay to {told}", self._heard.is_connected)

    @property
    def count(self):
        """How many messages have come out."""
        return len(self._heard.messages)

    def send(self, data):
        raw = rospy.AnyMsg()
        raw._buff = data
        self._publisher.publish(raw)

    def through(self, data):
        """What comes out for what is put in."""
        count = self.count
        self.send(data)
        wait_until("what was sent", lambda: self.count > count)
        return self._heard.messages[-1]._buff

    def told(self, message):
        return self._kind().deserialize(self.through(data_of(message)))


class TestFaultRelay(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.clock = rospy.Publisher("/clock", Clock, queue_size=1, latch=True)
        cls.scan = Passage("scan", "scan_faulty", LaserScan)
        cls.odometry = Passage("odom", "odom_faulty", Odometry)
        cls.command = Passage("cmd_vel", "cmd_vel_faulty", Twist)
        cls.show(FIRST)
        rospy.wait_for_service("fault_relay/add_fault", 20.0)
        cls.add_fault = rospy.ServiceProxy("fault_relay/add_fault", AddFault)

    def setUp(self):
        self.show(LAST)
        wait_until("the last fault", lambda: self.first_range() == 0.0)
        self.show(FIRST)
        wait_until("the faults to begin anew", lambda: self.first_range() == 1.0)

    @classmethod
    def show(cls, time):
        cls.clock.publish(rospy.Time.from_sec(time))

    def is_blind(self):
        return bool(np.isnan(self.scan.told(scan_message()).ranges).all())

    def first_range(self):
        return self.scan.told(scan_message()).ranges[0]

    def test_without_a_fault_all_is_passed_on_to_the_last_bit(self):
        for passage, message in (
            (self.scan, scan_message()),
            (self.scan, scan_message(angle_min=math.nan)),  # what it means is no matter of ours
            (self.odometry, odometry_message()),
            (self.command, command_message()),
        ):
            self.assertEqual(passage.through(data_of(message)), data_of(message))

    def test_a_fault_of_the_file_begins_and_ends_at_its_time(self):
        self.show(START)
        wait_until("it to be blind", self.is_blind)
        told, whole = self.scan.told(scan_message()), LaserScan().deserialize(data_of(scan_message()))
        told.ranges = whole.ranges
        self.assertEqual(data_of(told), data_of(whole), "nothing else is changed")
        for passage, message in ((self.odometry, odometry_message()), (self.command, command_message())):
            self.assertEqual(passage.through(data_of(message)), data_of(message))
        self.show(END)
        wait_until("it to see", lambda: not self.is_blind())

    def test_a_fault_that_is_asked_for_lasts_its_seconds(self):
        answer = self.add_fault("velocity_saturated", 2.0, 0.1)
        self.assertEqual((answer.success, answer.message), (True, ""))
        slow = Twist(Vector3(0.1, 0.1, 0.2), Vector3(0.3, 0.4, 0.5))
        self.assertEqual(self.command.told(command_message()), slow)
        self.assertEqual(self.scan.through(data_of(scan_message())), data_of(scan_message()))
        self.show(FIRST + 2.0)
        wait_until("it to be over", lambda: self.command.told(command_message()) == command_message())

    def test_what_comes_late_is_the_earlier_message(self):
        self.assertTrue(self.add_fault("commands_late", 5.0, 1.0).success)
        count, sent = self.command.count, [data_of(command_message(v)) for v in (0.1, 0.2, 0.3)]
        self.command.send(sent[0])
        self.assertEqual([self.command.through(data) for data in sent[1:]], sent[:2])
        self.assertEqual(self.command.count, count + 2)

    def test_what_cannot_be_relayed_or_makes_no_sense_is_refused_in_a_sentence(self):
        for asked, said in (
            (
                ("kidnapped", 0.0, 0.0),
                "kidnapped changes no scan, odometry or command, only wheels or the home",
            ),
            (("wheel_stuck", 0.0, 0.0), "wheel_stuck changes no scan, odometry or command"),
            (("scan_nans", 0.0, 0.0), "there is no fault 'scan_nans', did you mean scan_nan?"),
            (("scan_biased", 0.0, 99.0), "strength must be from"),
            (("scan_nan", -1.0, 0.0), "seconds must not be negative"),
        ):
            answer = self.add_fault(*asked)
            self.assertFalse(answer.success)
            self.assertIn(said, answer.message)
        self.assertFalse(self.is_blind())

    def test_what_it_cannot_start_with_is_told_in_a_line(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "home.yaml"
            path.write_text("faults:\n  - {kind: scan_nan}\n  - {kind: way_closed}\n")
            for name, argument, said in (
                (
                    "home",
                    f"_faults_file:={path}",
                    f"{path}:3: faults[2].kind cannot be used: way_closed changes",
                ),
                (
                    "circle",
                    "odom_faulty:=odom",
                    "odom_faulty is remapped to /odom, to which the relay subscribes",
                ),
                ("chance", "_seed:=-1", "/chance/seed must be not negative, got -1"),
            ):
                ended = subprocess.run(
                    [NODE, f"__name:={name}", argument],
                    capture_output=True, text=True, timeout=60.0, check=False,
                )  # fmt: skip
                self.assertEqual(ended.returncode, 2, ended.stderr)
                self.assertIn(f"error: {said}", ended.stderr)
                self.assertNotIn("Traceback", ended.stderr)

    def test_what_is_no_scan_is_left_out_and_does_not_end_the_node(self):
        self.assertTrue(self.add_fault("scan_biased", 5.0, 0.5).success)
        count, whole = self.scan.count, data_of(scan_message())
        self.scan.send(data_of(scan_message(angle_min=math.nan)))
        self.scan.send(whole[:-3])
        self.assertEqual(self.scan.told(scan_message()).ranges[0], 1.5)
        self.assertEqual(self.scan.count, count + 1)

    def test_the_transform_is_that_of_the_faulty_odometry(self):
        heard = Heard("/tf", TFMessage)
        wait_until("the sender of transforms", heard.is_connected)
        odometry = Passage("with_tf/wheel_odom", "with_tf/odom", Odometry)
        told = []

        def is_scaled():
            sent = odometry_message(0.5 * len(told), len(told))
            told.append(odometry.told(sent))
            return told[-1].pose.pose.position.x > sent.pose.pose.position.x

        wait_until("a fault", is_scaled)
        wait_until("its transform", lambda: len(heard.messages) >= len(told))
        for message, transforms in zip(told, heard.messages):
            (transform,) = transforms.transforms
            self.assertEqual(
                (transform.header.stamp, transform.header.frame_id), (message.header.stamp, "odom")
            )
            self.assertEqual(transform.child_frame_id, "base")
            at = message.pose.pose.position
            self.assertEqual(transform.transform.translation, Vector3(at.x, at.y, 0.25))


if __name__ == "__main__":
    rospy.init_node("test_fault_relay")
    rostest.rosrun("home_service_tests", "relayed_faults", TestFaultRelay)
