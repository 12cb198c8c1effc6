#!/usr/bin/env python3
"""Robots spawned while time passes: a TurtleBot with its mux, and one of the user's own in a namespace."""

import math
import unittest
from typing import get_type_hints

import numpy as np
import rospy
import rosservice
import rostest
from gazebo_msgs.srv import DeleteModel, SpawnModel
from geometry_msgs.msg import Pose, Twist
from kobuki_msgs.msg import BumperEvent, MotorPower
from nav_msgs.msg import Odometry
from recording import MessageRecorder
from sensor_msgs.msg import JointState
from std_msgs.msg import Empty, String
from tf2_msgs.msg import TFMessage
from waiting import PATIENCE_SECONDS, wait_until

from planar_ros.messages.conversion import LaserScanArrays, quaternion_of
from sim_bridge import robot_named
from sim_bridge.ros.sensor_topics import TOPICS
from sim_bridge.sensors.registry import SENSORS

WHEEL = """<link name="{side}"><inertial><mass value="0.5"/>
<inertia ixx="0.001" iyy="0.001" izz="0.001"/></inertial>
<collision><origin rpy="1.5707963 0 0"/><geometry><cylinder radius="0.1" length="0.04"/></geometry>
</collision></link>
<joint name="{side}_hinge" type="continuous"><parent link="chassis"/><child link="{side}"/>
<origin xyz="0 {y} 0"/><axis xyz="0 1 0"/></joint>"""
# As projects write it: the base at the height of the axle, the wheels' names from an older Gazebo.
ROVER = f"""<robot name="rover">
<link name="chassis">
<inertial><mass value="6"/><inertia ixx="0.1" iyy="0.1" izz="0.1"/></inertial>
<collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision>
<collision><origin xyz="-0.15 0 -0.05"/><geometry><sphere radius="0.05"/></geometry></collision>
<collision><origin xyz="0.15 0 -0.05"/><geometry><sphere radius="0.05"/></geometry></collision></link>
{WHEEL.format(side="left", y="0.15")}{WHEEL.format(side="right", y="-0.15")}
<link name="hokuyo"/>
<joint name="mount" type="fixed"><parent link="chassis"/><child link="hokuyo"/>
<origin xyz="0.1 0 0.2"/></joint>
<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so">
<leftJoint>right_hinge</leftJoint><rightJoint>left_hinge</rightJoint><legacyMode>true</legacyMode>
<wheelSeparation>0.3</wheelSeparation><wheelDiameter>0.2</wheelDiameter><robotBaseFrame>chassis</robotBaseFrame>
<publishWheelJointState>true</publishWheelJointState><odometrySource>world</odometrySource>
<updateRate>25</updateRate></plugin></gazebo>
<gazebo reference="hokuyo"><sensor type="ray" name="s"><update_rate>20</update_rate><ray><scan><horizontal>
<samples>181</samples><min_angle>-1.57</min_angle><max_angle>1.57</max_angle></horizontal></scan>
<range><min>0.1</min><max>10</max></range></ray>
<plugin name="l" filename="libgazebo_ros_laser.so"><topicName>laser/scan</topicName>
<frameName>hokuyo</frameName></plugin></sensor></gazebo></robot>"""

CART_WHEEL = """<link name="{side}"><pose>0 {y} 0.1 1.5707963 0 0</pose><inertial><mass>0.5</mass></inertial>
<collision name="c"><geometry><cylinder><radius>0.1</radius><length>0.04</length></cylinder></geometry>
</collision></link><joint name="{side}_hinge" type="revolute"><parent>chassis</parent><child>{side}</child>
<axis><xyz>0 0 -1</xyz></axis></joint>"""
CART = f"""<sdf version="1.6"><model name="any"><link name="chassis"><pose>0 0 0.1 0 0 0</pose>
<inertial><mass>6</mass></inertial>
<collision name="c"><geometry><box><size>0.4 0.2 0.1</size></box></geometry></collision>
<collision name="f"><pose>0.15 0 -0.05 0 0 0</pose><geometry><sphere><radius>0.05</radius></sphere></geometry>
</collision>
<collision name="b"><pose>-.15 0 -0.05 0 0 0</pose><geometry><sphere><radius>0.05</radius></sphere></geometry>
</collision></link>
{CART_WHEEL.format(side="left", y="0.15")}{CART_WHEEL.format(side="right", y="-0.15")}
<plugin name="drive" filename="libgazebo_ros_diff_drive.so"><leftJoint>left_hinge</leftJoint>
<rightJoint>right_hinge</rightJoint><wheelSeparation>0.3</wheelSeparation><wheelDiameter>0.2</wheelDiameter>
<robotBaseFrame>chassis</robotBaseFrame></plugin></model></sdf>"""

# Time over which an acceleration is measured [simulated s].
RISE_SECONDS = 0.7


def spawn(name, text, x, y, yaw, namespace="", kind="urdf"):
    service = f"/gazebo/spawn_{kind}_model"
    rospy.wait_for_service(service, PATIENCE_SECONDS)
    pose = Pose()
    pose.position.x, pose.position.y, pose.orientation = x, y, quaternion_of(yaw)
    return rospy.ServiceProxy(service, SpawnModel)(name, text, namespace, pose, "world")


class TestRobots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.turtlebot = spawn("mobile_base", robot_named("turtlebot_lidar").description(), 0.0, 0.0, 0.0)
        cls.rover = spawn("rover", ROVER, 3.0, 0.0, 3.14, "/rover")
        cls.odom, cls.rover_odom = (
            MessageRecorder("/odom", Odometry),
            MessageRecorder("/rover/odom", Odometry),
        )
        cls.truth = MessageRecorder("/base_pose_ground_truth", Odometry)
        cls.scan, cls.rover_scan = (
            MessageRecorder(topic, LaserScanArrays) for topic in ("/scan", "/rover/laser/scan")
        )
        cls.joints, cls.active = (
            MessageRecorder("/rover/joint_states", JointState),
            MessageRecorder("/cmd_vel_mux/active", String),
        )
        cls.tf, cls.bumper = (
            MessageRecorder("/tf", TFMessage),
            MessageRecorder("/mobile_base/events/bumper", BumperEvent),
        )
        topics = ("navi", "teleop")
        cls.inputs = {
            one: rospy.Publisher(f"/cmd_vel_mux/input/{one}", Twist, queue_size=1) for one in topics
        }
        cls.raw = rospy.Publisher("/navigation_velocity_smoother/raw_cmd_vel", Twist, queue_size=1)
        cls.rover_command = rospy.Publisher("/rover/cmd_vel", Twist, queue_size=1)
        cls.motors = rospy.Publisher("/mobile_base/commands/motor_power", MotorPower, queue_size=1)
        cls.reset = rospy.Publisher("/mobile_base/commands/reset_odometry", Empty, queue_size=1)
        publishers = (*cls.inputs.values(), cls.raw, cls.rover_command, cls.motors, cls.reset)
        wait_until("subscribers", lambda: all(one.get_num_connections() for one in publishers))
        cls.scan.next()

    def command(self, v, omega, *publishers):
        """Commands the same on several topics for a period of the odometry, which is returned."""
        command = Twist()
        command.linear.x, command.angular.z = v, omega
        for publisher in publishers:
            publisher.publish(command)
        return self.odom.next()

    def turns(self, omega, *publishers):
        """Return whether the robot turns at a commanded rate."""
        return abs(self.command(0.0, omega, *publishers).twist.twist.angular.z - omega) < 0.1

    def is_driven_by(self, name):
        return self.active.messages and self.active.messages[-1].data == name

    def test_every_sensor_that_a_plugin_brings_has_topics(self):
        self.assertLessEqual({get_type_hints(read)["return"] for read in SENSORS.values()}, set(TOPICS))

    def test_1_both_are_spawned_and_a_name_is_not_taken_twice(self):
        self.assertTrue(self.turtlebot.success, self.turtlebot.status_message)
        self.assertTrue(self.rover.success, self.rover.status_message)
        again = spawn("rover", ROVER, -1.0, 0.0, 0.0)
        self.assertEqual(again.status_message, "SpawnModel: Failure - entity already exists.")
        broken = spawn("other", ROVER.replace(">left_hinge<", ">hinge<"), -1.0, 0.0, 0.0)
        self.assertIn("no joint 'hinge'", broken.status_message)

    def test_2_each_has_its_own_topics_and_frames(self):
        odometry, scan = self.rover_odom.next(), self.rover_scan.next()
        self.assertEqual((odometry.header.frame_id, odometry.child_frame_id), ("rover/odom", "rover/chassis"))
        self.assertEqual((scan.header.frame_id, len(scan.ranges)), ("rover/hokuyo", 181))
        self.assertAlmostEqual(odometry.pose.pose.position.x, 3.0, delta=0.02, msg="the source is the world")
        self.assertAlmostEqual(self.odom.next().pose.pose.position.x, 0.0, delta=0.1)
        expected = {("odom", "base_footprint"), ("rover/odom", "rover/chassis")}
        wait_until("both transforms", lambda: self.frames_sent() >= expected)
        self.assertEqual(self.frames_sent(), expected)
        self.assertEqual(sorted(self.joints.next().name), ["left_hinge", "right_hinge"])

    def frames_sent(self):
        sent = [one for message in list(self.tf.messages) for one in message.transforms]
        return {(one.header.frame_id, one.child_frame_id) for one in sent}

    def test_3_a_command_turns_one_robot_only_and_to_the_left(self):
        command = Twist()
        command.angular.z = 0.5
        self.rover_command.publish(command)
        wait_until("a turn", lambda: self.rover_odom.next().twist.twist.angular.z > 0.45)
        self.assertAlmostEqual(self.odom.next().twist.twist.angular.z, 0.0, delta=0.05)
        for _ in range(60):
            self.odom.next()
        self.assertGreater(self.rover_odom.next().twist.twist.angular.z, 0.45, "it keeps its last command")
        self.rover_command.publish(Twist())
        wait_until("a stop", lambda: abs(self.rover_odom.next().twist.twist.angular.z) < 0.01)

    def test_4_the_mux_prefers_teleoperation_and_publishes_the_active_input(self):
        navi, teleop = self.inputs["navi"], self.inputs["teleop"]
        wait_until("navigation", lambda: self.turns(0.5, navi) and self.is_driven_by("Navigation"))

        def teleoperation_drives():
            self.command(0.0, 0.5, navi)
            return self.turns(-0.5, teleop) and self.is_driven_by("Teleoperation")

        wait_until("teleoperation", teleoperation_drives)
        wait_until("silence", lambda: self.is_driven_by("idle"))

    def test_5_raw_commands_are_smoothed(self):
        rises = []

        def speeds_up():
            rises.append(self.steepest_rise())
            return rises[-1] > 1.35

        # A pause between commands, on a busy machine, lets the smoother brake: then it is tried again.
        wait_until("nearly 2 rad/s^2", speeds_up)
        self.assertLess(max(rises), 2.3, "the robot itself could do 6 rad/s^2")
        wait_until("rest", lambda: self.turns(0.0, self.raw))

    def steepest_rise(self):
        """Greatest mean acceleration over RISE_SECONDS, in rad/s^2, from rest to nearly 2 rad/s."""
        wait_until("rest", lambda: self.turns(0.0, self.raw))
        first = len(self.odom.messages)
        wait_until("two radians a second", lambda: self.turns(2.0, self.raw))
        seen = [(one.header.stamp.to_sec(), one.twist.twist.angular.z) for one in self.odom.messages[first:]]
        stamps, rates = (np.array(column) for column in zip(*seen))
        grid = np.arange(stamps[0], stamps[-1] - RISE_SECONDS, 0.01)
        rises = np.interp(grid + RISE_SECONDS, stamps, rates) - np.interp(grid, stamps, rates)
        return rises.max() / RISE_SECONDS

    def test_6_kobuki_subscribes_to_its_commands_and_publishes_bumps(self):
        navi = self.inputs["navi"]
        wait_until("a turn", lambda: self.turns(0.5, navi))
        self.motors.publish(MotorPower(MotorPower.OFF))
        wait_until("motors off", lambda: abs(self.command(0.0, 0.5, navi).twist.twist.angular.z) < 0.05)
        for _ in range(30):
            odometry = self.command(0.0, 0.5, navi)
        self.assertAlmostEqual(odometry.twist.twist.angular.z, 0.0, delta=0.05)
        wait_until("silence", lambda: self.is_driven_by("idle"))
        self.motors.publish(MotorPower(MotorPower.ON))
        self.reset.publish()
        wait_until("odometry at zero", lambda: abs(self.odom.next().pose.pose.orientation.z) < 0.01)
        wait_until("a bump", lambda: self.command(0.6, 0.0, navi) and self.bumper.messages)
        self.assertEqual(self.bumper.messages[0].state, BumperEvent.PRESSED)
        self.assertFalse(math.isnan(self.truth.next().pose.pose.position.x))

    def test_7_a_robot_described_in_sdf_is_driven_too(self):
        spawned = spawn("cart", CART, 2.0, 3.0, 1.0, "/cart", "sdf")
        self.assertTrue(spawned.success, spawned.status_message)
        odometry, velocity = (
            MessageRecorder("/cart/odom", Odometry),
            rospy.Publisher("/cart/cmd_vel", Twist, queue_size=1),
        )
        wait_until("the cart", velocity.get_num_connections)
        self.assertAlmostEqual(odometry.next().pose.pose.position.x, 2.0, delta=0.05)
        command = Twist()
        command.angular.z = 0.5
        velocity.publish(command)
        wait_until("a turn", lambda: odometry.next().twist.twist.angular.z > 0.4)

    def test_8_a_deleted_robot_takes_its_topics_along_and_can_come_again(self):
        delete = rospy.ServiceProxy("/gazebo/delete_model", DeleteModel)
        for name, topic in (("rover", "/rover/odom"), ("mobile_base", "/cmd_vel_mux/active")):
            self.assertTrue(delete(name).success)
            wait_until("the topics to go", lambda topic=topic: topic not in published())
        wait_until("the mux to go", lambda: not rosservice.get_service_node("/cmd_vel_mux/set_parameters"))
        again = spawn("mobile_base", robot_named("turtlebot_lidar").description(), 0.0, 0.0, 0.0)
        self.assertTrue(again.success, again.status_message)
        rospy.wait_for_service("/cmd_vel_mux/set_parameters", PATIENCE_SECONDS)
        self.odom.next()


def published():
    return {topic for topic, _ in rospy.get_published_topics()}


if __name__ == "__main__":
    rospy.init_node("robots")
    rostest.rosrun("home_service_tests", "robots", TestRobots)
