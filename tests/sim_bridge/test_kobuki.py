#!/usr/bin/env python3
"""What a Kobuki feels, by its events, its state and its cloud of points; and who may drive it."""

import math
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client
from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import SetModelState
from geometry_msgs.msg import Pose, Twist, Vector3
from kobuki_msgs.msg import BumperEvent, CliffEvent, SensorState, WheelDropEvent
from nav_msgs.msg import Odometry
from recording import MessageRecorder
from sensor_msgs.msg import Imu, JointState, PointCloud2
from sensor_msgs.point_cloud2 import read_points
from std_msgs.msg import String
from std_srvs.srv import Empty
from waiting import PATIENCE_SECONDS, wait_until

from planar_ros.messages.conversion import quaternion_of

INPUTS = {
    "input/navi": "Navigation",
    "input/switch": "Switch",
    "input/teleop": "Teleoperation",
    "input/safety_controller": "Safe reactive controller",
}
JOYSTICK = "subscribers: [{name: Joystick, topic: input/joy, timeout: 0.5, priority: 1}]"


def connected(topic, kind):
    """Listens once there is a publisher."""
    listener = MessageRecorder(topic, kind)
    wait_until(f"a publisher of {topic}", listener.is_connected)
    return listener


def nearest_of(cloud):
    """Metres from the middle of the robot to the nearest of its points."""
    return min(math.hypot(x, y, z) for x, y, z in read_points(cloud))


class TestKobuki(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bumper = connected("mobile_base/events/bumper", BumperEvent)
        cls.cliff = connected("mobile_base/events/cliff", CliffEvent)
        cls.drop = connected("mobile_base/events/wheel_drop", WheelDropEvent)
        cls.state = connected("mobile_base/sensors/core", SensorState)
        cls.cloud = connected("mobile_base/sensors/bumper_pointcloud", PointCloud2)
        cls.odom, cls.active = connected("odom", Odometry), connected("cmd_vel_mux/active", String)
        cls.velocity = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        wait_until("the simulation", cls.velocity.get_num_connections)
        cls.odom.next()

    def setUp(self):
        rospy.ServiceProxy("/gazebo/reset_world", Empty)()
        self.odom.next()
        for topic in (self.bumper, self.cliff, self.drop, self.state, self.cloud):
            topic.messages.clear()

    def drive_until(self, what, v, is_met):
        def drives():
            self.velocity.publish(Twist(linear=Vector3(v, 0.0, 0.0)))
            self.odom.next()
            return is_met()

        wait_until(what, drives)

    def test_a_bump_is_published_as_pressed_released_and_as_points_for_costmaps(self):
        self.drive_until("a bump", 0.4, lambda: self.cloud.messages and self.bumper.messages)
        pressed = self.bumper.messages[0]
        self.assertEqual((pressed.bumper, pressed.state), (BumperEvent.CENTER, BumperEvent.PRESSED))
        wait_until("the state", lambda: any(one.bumper for one in self.state.messages))
        bits = {one.bumper for one in self.state.messages}
        self.assertEqual(bits, {0, SensorState.BUMPER_CENTRE})
        self.assertEqual(self.state.messages[-1].header.frame_id, "base_link")
        cloud = self.cloud.messages[0]
        self.assertEqual((cloud.header.frame_id, cloud.width, cloud.height), ("base_link", 3, 1))
        left, centre, right = read_points(cloud)
        for value, expected in zip(centre, (0.24, 0.0, 0.04)):
            self.assertAlmostEqual(value, expected, places=6)
        self.assertGreater(min(math.hypot(*left), math.hypot(*right)), 50.0, "out of reach")
        self.drive_until("the release", -0.3, lambda: self.bumper.messages[-1].state == BumperEvent.RELEASED)
        wait_until("a cloud that clears", lambda: nearest_of(self.cloud.messages[-1]) > 50.0)
        count = len(self.cloud.messages)
        for _ in range(10):
            self.odom.next()
        self.assertEqual(len(self.cloud.messages), count, "one that clears, then silence")

    def test_a_cliff_is_published_before_the_wheels_drop(self):
        aside = Pose()
        aside.position.y, aside.orientation = -1.0, quaternion_of(-math.pi / 2.0)
        set_state = rospy.ServiceProxy("/gazebo/set_model_state", SetModelState)
        set_state(ModelState(model_name="mobile_base", pose=aside))
        self.drive_until("a cliff", 0.4, lambda: self.cliff.messages)
        first = self.cliff.messages[0]
        self.assertEqual((first.sensor, first.state), (CliffEvent.CENTER, CliffEvent.CLIFF))
        self.drive_until("both wheels to hang", 0.4, lambda: len(self.drop.messages) >= 2)
        # By the stamps of the state: events have none, and have separate connections.
        before = next(state for state in self.state.messages if state.cliff or state.wheel_drop)
        self.assertEqual((before.wheel_drop, before.cliff), (0, SensorState.CLIFF_CENTRE))
        wheels = {(one.wheel, one.state) for one in self.drop.messages[:2]}
        hanging = {WheelDropEvent.LEFT, WheelDropEvent.RIGHT}
        self.assertEqual(wheels, {(wheel, WheelDropEvent.DROPPED) for wheel in hanging})
        both = SensorState.WHEEL_DROP_LEFT | SensorState.WHEEL_DROP_RIGHT
        wait_until("the state of both", lambda: self.state.messages[-1].wheel_drop == both)
        self.assertTrue(self.state.messages[-1].cliff & SensorState.CLIFF_CENTRE)

    def test_each_input_of_the_mux_gives_way_to_those_above_it(self):
        publishers = [rospy.Publisher(f"cmd_vel_mux/{topic}", Twist, queue_size=1) for topic in INPUTS]
        wait_until("the mux", lambda: all(one.get_num_connections() for one in publishers))
        for count, name in enumerate(INPUTS.values(), 1):
            self.drive_by(publishers[:count], name)
        wait_until("silence", lambda: self.active.messages[-1].data == "idle")

    def test_the_mux_takes_other_inputs_while_it_runs_but_no_senseless_ones(self):
        client = Client("cmd_vel_mux", timeout=PATIENCE_SECONDS)
        client.update_configuration({"yaml_cfg_data": JOYSTICK})
        joystick = rospy.Publisher("cmd_vel_mux/input/joy", Twist, queue_size=1)
        wait_until("the new input", joystick.get_num_connections)
        self.drive_by([joystick], "Joystick")
        client.update_configuration({"yaml_cfg_data": "subscribers: {"})
        self.drive_by([joystick], "Joystick")
        client.update_configuration({"restore_defaults": True})
        navigation = rospy.Publisher("cmd_vel_mux/input/navi", Twist, queue_size=1)
        wait_until("the old inputs", navigation.get_num_connections)
        self.drive_by([navigation], "Navigation")

    def drive_by(self, publishers, name):
        """Publish commands on some inputs until the mux selects the input of that name."""

        def drives():
            for publisher in publishers:
                publisher.publish(Twist())
            return self.active.messages[-1].data == name

        wait_until(name, drives)

    def test_measurements_have_frames_and_covariances(self):
        covariance = self.odom.next().pose.covariance
        self.assertEqual([covariance[7 * axis] for axis in range(6)], [0.1, 0.1, 1e6, 1e6, 1e6, 0.05])
        imu = rospy.wait_for_message("mobile_base/sensors/imu_data", Imu, PATIENCE_SECONDS)
        self.assertEqual(imu.header.frame_id, "base_link")
        self.assertEqual([imu.orientation_covariance[4 * axis] for axis in range(3)], [1e6, 1e6, 0.05])
        self.assertEqual([imu.angular_velocity_covariance[4 * axis] for axis in range(3)], [1e6, 1e6, 0.05])
        joints = rospy.wait_for_message("joint_states", JointState, PATIENCE_SECONDS)
        self.assertEqual(joints.header.frame_id, "base_link")
        self.assertEqual((len(joints.position), len(joints.velocity)), (2, 2))

    def test_odometry_starts_at_zero_wherever_the_robot_stands(self):
        truth = rospy.wait_for_message(
            "base_pose_ground_truth", Odometry, PATIENCE_SECONDS
        ).pose.pose.position
        self.assertAlmostEqual(truth.x, -0.5, delta=0.01)
        start = self.odom.messages[0].pose.pose.position
        self.assertLess(math.hypot(start.x, start.y), 0.01)


if __name__ == "__main__":
    rospy.init_node("kobuki")
    rostest.rosrun("home_service_tests", "kobuki", TestKobuki)
