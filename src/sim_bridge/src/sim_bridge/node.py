"""The simulation as a ROS node: Gazebo's TurtleBot topics, simulated time, lock-step with other nodes."""

import dataclasses
import threading
import time

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry as OdometryMsg
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Header, String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

from planar import Pose2, Scan, Twist2
from planar.settings import check
from planar_ros.messages import LaserScanArrays, pose2_from_msg, pose2_to_msg, time_of, transform_msg
from planar_ros.parameters import read_settings
from planar_ros.progress import TOPIC as PROGRESS_TOPIC
from planar_ros.shell import run
from planar_ros.waiting import Waiting
from sim_bridge.cli import model_folders
from sim_bridge.config import BridgeSettings, SimulationSettings
from sim_bridge.errors import WorldError
from sim_bridge.pacing import Pacer
from sim_bridge.robot import Observation
from sim_bridge.robots import robot_named
from sim_bridge.sdf import load_world
from sim_bridge.simulation import Simulation

ODOM_FRAME = "odom"
# The frame of the world file; it coincides with a map made or rendered of that world.
WORLD_FRAME = "world"
# Kobuki's: x, y and yaw are measured, the rest is not.
ODOMETRY_COVARIANCE = np.diag([0.1, 0.1, 1e6, 1e6, 1e6, 0.05]).ravel().tolist()
RATE_PERIOD_SECONDS = 1.0
# So that a shutdown is noticed at once.
LONGEST_WAIT_SECONDS = 0.05


class Bridge:
    """Steps a Simulation as fast as it may and translates between it and ROS."""

    def __init__(self):
        of_simulation, of_bridge = (
            {field.name for field in dataclasses.fields(kind)}
            for kind in (SimulationSettings, BridgeSettings)
        )
        settings = read_settings(BridgeSettings, ignore=of_simulation)
        simulation_settings = read_settings(SimulationSettings, ignore=of_bridge)
        rate = simulation_settings.odometry_rate
        self._clock_steps = _steps_between(settings.clock_rate, rate, "clock_rate")
        self._joint_steps = _steps_between(settings.joint_state_rate, rate, "joint_state_rate")
        self._robot = robot_named(settings.robot)
        world = load_world(settings.world, model_folders())
        for warning in world.warnings:
            rospy.logwarn("%s", warning)
        self._simulation = Simulation(
            world,
            self._robot,
            simulation_settings,
            settings.seed,
            Pose2(settings.x, settings.y, settings.yaw),
        )
        names = [name.lstrip("/") for name in settings.wait_for.split()]
        self._pacer = Pacer(settings.speed, names)
        self._changed = threading.Condition()
        self._command = None
        self._boxes = []
        self._contacts = None
        self._advertise()
        self._subscribe()
        Waiting({f"{name} on {PROGRESS_TOPIC}": self._follows(name) for name in names})

    def run(self) -> None:
        """Steps until shutdown."""
        steps, stamp = 0, 0.0
        period_start, stamp_at_start = time.monotonic(), 0.0
        while self._wait_for_turn(stamp + self._simulation.step_seconds):
            observation = self._simulation.step(self._take_orders())
            steps, stamp = steps + 1, observation.stamp
            self._publish(observation, steps)
            elapsed = time.monotonic() - period_start
            if elapsed >= RATE_PERIOD_SECONDS:
                self._real_time_factor.publish((stamp - stamp_at_start) / elapsed)
                period_start, stamp_at_start = time.monotonic(), stamp
        self._simulation.close()

    def _advertise(self):
        def publisher(topic, kind, queue_size=10, latch=False):
            return rospy.Publisher(topic, kind, queue_size=queue_size, latch=latch, tcp_nodelay=True)

        self._clock = publisher("/clock", Clock)
        self._tf = publisher("/tf", TFMessage, 100)
        self._odom = publisher("odom", OdometryMsg, 100)
        self._scan = publisher("scan", LaserScanArrays)
        self._joints = publisher("joint_states", JointState)
        self._truth = publisher("base_pose_ground_truth", OdometryMsg, 100)
        self._touches = publisher("contacts", String, latch=True)
        self._real_time_factor = publisher("~real_time_factor", Float64)

    def _subscribe(self):
        for topic in ("cmd_vel", "mobile_base/commands/velocity"):
            rospy.Subscriber(topic, Twist, self._on_command, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber(PROGRESS_TOPIC, Header, self._on_progress, queue_size=100, tcp_nodelay=True)
        rospy.Subscriber("~add_box", Marker, self._on_box, queue_size=10)

    def _on_command(self, message):
        command = Twist2(message.linear.x, message.angular.z)
        if not command.is_finite():
            rospy.logwarn_throttle(1.0, "velocity command is not finite: the robot stops")
        with self._changed:
            self._command = command

    def _on_progress(self, message):
        with self._changed:
            self._pacer.report(message.frame_id.lstrip("/"), message.stamp.to_sec())
            self._changed.notify_all()

    def _on_box(self, message):
        with self._changed:
            self._boxes.append(message)

    def _follows(self, name):
        return lambda: not self._pacer.is_missing(name)

    def _wait_for_turn(self, stamp) -> bool:
        """Waits until the step to ``stamp`` may be taken; False if the node is shut down instead."""
        with self._changed:
            while not rospy.is_shutdown():
                wall = time.monotonic()
                delay = self._pacer.delay(stamp, wall)
                if delay <= 0.0:
                    return True
                for name in self._pacer.give_up(stamp, wall):
                    rospy.logwarn("no progress of %s: the simulation goes on without it in real time", name)
                self._changed.wait(min(delay, LONGEST_WAIT_SECONDS))
        return False

    def _take_orders(self):
        with self._changed:
            command, self._command = self._command, None
            boxes, self._boxes = self._boxes, []
        for box in boxes:
            self._add_box(box)
        return command

    def _add_box(self, message):
        size = (message.scale.x, message.scale.y, message.scale.z)
        name = message.ns or f"box_{message.id}"
        try:
            self._simulation.add_box(name, size, pose2_from_msg(message.pose))
            rospy.loginfo("%s added", name)
        except WorldError as error:
            rospy.logwarn("box not added: %s", error)

    def _publish(self, observation: Observation, steps: int):
        stamp = time_of(observation.stamp)
        odometry, base_frame = observation.odometry, self._robot.base_frame
        self._odom.publish(
            _odometry_msg(odometry.base_in_odom, odometry.twist, stamp, ODOM_FRAME, base_frame)
        )
        self._tf.publish(TFMessage([transform_msg(odometry.base_in_odom, ODOM_FRAME, base_frame, stamp)]))
        self._truth.publish(
            _odometry_msg(observation.base_in_world, observation.twist, stamp, WORLD_FRAME, base_frame)
        )
        if observation.scan is not None:
            self._scan.publish(_scan_msg(observation.scan, self._robot.laser.frame))
        if steps % self._joint_steps == 0:
            self._joints.publish(self._joint_state_msg(observation, stamp))
        if observation.contacts != self._contacts:
            self._contacts = observation.contacts
            self._touches.publish("\n".join(observation.contacts))
        # Last, so that what it wakes up finds the data of this moment.
        if steps % self._clock_steps == 0:
            self._clock.publish(stamp)

    def _joint_state_msg(self, observation: Observation, stamp) -> JointState:
        drive = self._robot.drive
        message = JointState()
        message.header.stamp = stamp
        message.header.frame_id = "base_link"
        message.name = [drive.left_joint, drive.right_joint]
        message.position = observation.wheel_angles
        message.velocity = observation.wheel_speeds
        return message


def _odometry_msg(base: Pose2, twist: Twist2, stamp, frame: str, base_frame: str) -> OdometryMsg:
    message = OdometryMsg()
    message.header.stamp = stamp
    message.header.frame_id = frame
    message.child_frame_id = base_frame
    message.pose.pose = pose2_to_msg(base)
    message.twist.twist.linear.x = twist.v
    message.twist.twist.angular.z = twist.omega
    if frame == ODOM_FRAME:
        message.pose.covariance = message.twist.covariance = ODOMETRY_COVARIANCE
    return message


def _scan_msg(scan: Scan, frame: str) -> LaserScanArrays:
    message = LaserScanArrays()
    message.header.stamp = time_of(scan.stamp)
    message.header.frame_id = frame
    message.angle_min = scan.angle_min
    message.angle_increment = scan.angle_increment
    message.angle_max = scan.angle_min + scan.angle_increment * (len(scan.ranges) - 1)
    message.range_min, message.range_max = scan.range_min, scan.range_max
    message.ranges = scan.ranges
    message.intensities = np.empty(0, dtype=np.float32)
    return message


def _steps_between(rate: int, step_rate: int, name: str) -> int:
    check(step_rate % rate == 0, f"~{name}", f"a divisor of odometry_rate ({step_rate})", rate)
    return step_rate // rate


def main():
    run("sim_bridge", lambda: Bridge().run())
