#!/usr/bin/env python3
"""The relay passes messages on to the last bit, or as the faults of file and service change them."""

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
from nav_msgs.msg import Odometry
from recording import MessageRecorder
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from sim_bridge_msgs.srv import AddFault
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage
from waiting import wait_until

NODE = roslib.packages.find_node("sim_bridge", "fault_relay")[0]
# Time of the clock at the start of each test; when it goes back the faults restart.
FIRST = 100.0
# Faults of the file: all ranges are NaN from START to END, and 0 from LAST on.
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
    """Publishes bytes on the input of a relay and collects those of its output."""

    def __init__(self, topic, output, kind):
        self._kind = kind
        self._publisher = rospy.Publisher(topic, kind, queue_size=100)
        self._output = MessageRecorder(output, rospy.AnyMsg)
        wait_until(f"a relay of {topic}", lambda: self._publisher.get_num_connections() > 0)
        wait_until(f"a relay to {output}", self._output.is_connected)

    @property
    def count(self):
        """Number of messages of the output."""
        return len(self._output.messages)

    def send(self, data):
        raw = rospy.AnyMsg()
        raw._buff = data
        self._publisher.publish(raw)

    def through(self, data):
        """Return the output for an input."""
        count = self.count
        self.send(data)
        wait_until("what was sent", lambda: self.count > count)
        return self._output.messages[-1]._buff

    def relay(self, message):
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
        wait_until("the faults to restart", lambda: self.first_range() == 1.0)

    @classmethod
    def show(cls, time):
        cls.clock.publish(rospy.Time.from_sec(time))

    def is_all_nan(self):
        return bool(np.isnan(self.scan.relay(scan_message()).ranges).all())

    def first_range(self):
        return self.scan.relay(scan_message()).ranges[0]

    def test_without_a_fault_all_is_passed_on_to_the_last_bit(self):
        for passage, message in (
            (self.scan, scan_message()),
            (self.scan, scan_message(angle_min=math.nan)),  # invalid, but no fault reads it
            (self.odometry, odometry_message()),
            (self.command, command_message()),
        ):
            self.assertEqual(passage.through(data_of(message)), data_of(message))

    def test_a_fault_of_the_file_begins_and_ends_at_its_time(self):
        self.show(START)
        wait_until("ranges of NaN", self.is_all_nan)
        faulty, original = self.scan.relay(scan_message()), LaserScan().deserialize(data_of(scan_message()))
        faulty.ranges = original.ranges
        self.assertEqual(data_of(faulty), data_of(original), "nothing else is changed")
        for passage, message in ((self.odometry, odometry_message()), (self.command, command_message())):
            self.assertEqual(passage.through(data_of(message)), data_of(message))
        self.show(END)
        wait_until("valid ranges", lambda: not self.is_all_nan())

    def test_an_added_fault_lasts_its_seconds(self):
        answer = self.add_fault("velocity_saturated", 2.0, 0.1)
        self.assertEqual((answer.success, answer.message), (True, ""))
        slow = Twist(Vector3(0.1, 0.1, 0.2), Vector3(0.3, 0.4, 0.5))
        self.assertEqual(self.command.relay(command_message()), slow)
        self.assertEqual(self.scan.through(data_of(scan_message())), data_of(scan_message()))
        self.show(FIRST + 2.0)
        wait_until("it to be over", lambda: self.command.relay(command_message()) == command_message())

    def test_a_delayed_message_is_the_earlier_one(self):
        self.assertTrue(self.add_fault("commands_late", 5.0, 1.0).success)
        count, sent = self.command.count, [data_of(command_message(v)) for v in (0.1, 0.2, 0.3)]
        self.command.send(sent[0])
        self.assertEqual([self.command.through(data) for data in sent[1:]], sent[:2])
        self.assertEqual(self.command.count, count + 2)

    def test_faults_that_cannot_be_relayed_and_invalid_ones_are_refused_with_a_reason(self):
        for fault, reason in (
            (
                ("kidnapped", 0.0, 0.0),
                "kidnapped changes no scan, odometry or command, only wheels or the home",
            ),
            (("wheel_stuck", 0.0, 0.0), "wheel_stuck changes no scan, odometry or command"),
            (("scan_nans", 0.0, 0.0), "there is no fault 'scan_nans' (did you mean \"scan_nan\"?)"),
            (("scan_biased", 0.0, 99.0), "strength must be from"),
            (("scan_nan", -1.0, 0.0), "seconds must not be negative"),
        ):
            answer = self.add_fault(*fault)
            self.assertFalse(answer.success)
            self.assertIn(reason, answer.message)
        self.assertFalse(self.is_all_nan())

    def test_an_error_at_the_start_is_reported_in_a_line(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "home.yaml"
            path.write_text("faults:\n  - {kind: scan_nan}\n  - {kind: way_closed}\n")
            for name, argument, reason in (
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
                self.assertIn(f"error: {reason}", ended.stderr)
                self.assertNotIn("Traceback", ended.stderr)

    def test_an_invalid_scan_is_dropped_and_does_not_end_the_node(self):
        self.assertTrue(self.add_fault("scan_biased", 5.0, 0.5).success)
        count, whole = self.scan.count, data_of(scan_message())
        self.scan.send(data_of(scan_message(angle_min=math.nan)))
        self.scan.send(whole[:-3])
        self.assertEqual(self.scan.relay(scan_message()).ranges[0], 1.5)
        self.assertEqual(self.scan.count, count + 1)

    def test_the_transform_is_that_of_the_faulty_odometry(self):
        received = MessageRecorder("/tf", TFMessage)
        wait_until("the sender of transforms", received.is_connected)
        odometry = Passage("with_tf/wheel_odom", "with_tf/odom", Odometry)
        published = []

        def is_scaled():
            sent = odometry_message(0.5 * len(published), len(published))
            published.append(odometry.relay(sent))
            return published[-1].pose.pose.position.x > sent.pose.pose.position.x

        wait_until("a fault", is_scaled)
        wait_until("its transform", lambda: len(received.messages) >= len(published))
        for message, transforms in zip(published, received.messages):
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
