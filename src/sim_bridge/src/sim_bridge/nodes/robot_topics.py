"""A robot's topics and transforms."""

from typing import List, Optional, Union

import numpy as np
import rospy
from geometry_msgs.msg import TransformStamped, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from std_msgs.msg import Empty, String

from planar import Pose2, Scan, Twist2
from planar_ros.messages import LaserScanArrays, pose2_to_msg, time_of, transform_msg
from sim_bridge.nodes.orders import Orders
from sim_bridge.nodes.performance import CountingPublisher
from sim_bridge.nodes.sensor_topics import SensorTopics
from sim_bridge.robot import Observation
from sim_bridge.scene import Scene

# The frame of the world file; it coincides with a map made or rendered of that world.
WORLD_FRAME = "world"
# Kobuki's: x, y and yaw are measured, the rest is not.
ODOMETRY_COVARIANCE = np.diag([0.1, 0.1, 1e6, 1e6, 1e6, 0.05]).ravel().tolist()


class RobotTopics:
    """Tells what a robot observes and takes its commands; its topics are below ``namespace``.

    ``tf_prefix`` is put before the names of its frames. ``joint_steps``: steps between two states of the
    joints, if the robot does not say how many.
    """

    def __init__(
        self, scene: Scene, name: str, orders: Orders, joint_steps: int, namespace: str, tf_prefix: str
    ):
        self._scene = scene
        self._name = name
        self._profile = profile = scene.robot(name).profile
        self._orders = orders
        self._namespace = namespace
        self._tf_prefix = f"{tf_prefix}/" if tf_prefix else ""
        self._steps = 0
        self._odom_steps = self._steps_of(profile.odometry.rate, 1)
        self._command: Optional[Twist2] = None
        self._contacts = None
        self._connections: List[Union[rospy.Publisher, rospy.Subscriber]] = []
        self._odom = self._publisher(profile.odometry.topic, Odometry, 100)
        self._truth = self._publisher("base_pose_ground_truth", Odometry, 100)
        self._scans = [self._publisher(laser.topic, LaserScanArrays) for laser in profile.lasers]
        self._sensors = SensorTopics(scene, name, self._publisher, self._frame)
        self._touches = self._publisher("contacts", String, latch=True)
        if profile.joint_states is not None:
            self._joints = self._publisher(profile.joint_states.topic, JointState)
            self._joint_steps = self._steps_of(profile.joint_states.rate, joint_steps)
        for topic in profile.drive.command_topics:
            self._subscribe(topic, Twist, self._on_command)
        if profile.kobuki is not None:
            self._subscribe("mobile_base/commands/reset_odometry", Empty, self._on_reset_odometry)

    def take_command(self) -> Optional[Twist2]:
        """The command that has come since the last call, if any."""
        command, self._command = self._command, None
        return command

    def publish(self, observation: Observation) -> List[TransformStamped]:
        """Tells what was observed, but for the transforms, which it returns."""
        self._steps += 1
        stamp = time_of(observation.stamp)
        for publisher, laser, scan in zip(self._scans, self._profile.lasers, observation.scans):
            if scan is not None:
                publisher.publish(_scan_msg(scan, self._frame(laser.frame)))
        if self._profile.joint_states is not None and self._steps % self._joint_steps == 0:
            self._joints.publish(self._joint_state_msg(observation, stamp))
        if observation.contacts != self._contacts:
            self._contacts = observation.contacts
            self._touches.publish("\n".join(observation.contacts))
        self._sensors.publish(self._steps, stamp)
        if self._steps % self._odom_steps:
            return []
        return self._publish_motion(observation, stamp)

    def publishers(self) -> List[CountingPublisher]:
        """Of all topics of the robot."""
        return [topic for topic in self._connections if isinstance(topic, CountingPublisher)]

    def close(self) -> None:
        """Ends the topics."""
        for connection in self._connections:
            connection.unregister()

    def _publish_motion(self, observation: Observation, stamp) -> List[TransformStamped]:
        profile, odometry = self._profile.odometry, observation.odometry
        base_frame, odom_frame = self._frame(profile.base_frame), self._frame(profile.frame)
        message = _odometry_msg(odometry.base_in_odom, odometry.twist, stamp, odom_frame, base_frame)
        message.pose.covariance = message.twist.covariance = ODOMETRY_COVARIANCE
        self._odom.publish(message)
        self._truth.publish(
            _odometry_msg(observation.base_in_world, observation.twist, stamp, WORLD_FRAME, base_frame)
        )
        if not profile.sends_transform:
            return []
        return [transform_msg(odometry.base_in_odom, odom_frame, base_frame, stamp)]

    def _steps_of(self, rate: Optional[float], default: int) -> int:
        """Steps of the scene between two messages that come ``rate`` times a second."""
        return default if rate is None else max(round(1.0 / self._scene.step_seconds / rate), 1)

    def _publisher(self, topic, kind, queue_size=10, latch=False):
        name = rospy.names.ns_join(self._namespace, topic)
        publisher = CountingPublisher(name, kind, queue_size=queue_size, latch=latch, tcp_nodelay=True)
        self._connections.append(publisher)
        return publisher

    def _subscribe(self, topic, kind, callback):
        name = rospy.names.ns_join(self._namespace, topic)
        self._connections.append(rospy.Subscriber(name, kind, callback, queue_size=1, tcp_nodelay=True))

    def _frame(self, name: str) -> str:
        return self._tf_prefix + name.lstrip("/")

    def _on_command(self, message):
        command = Twist2(message.linear.x, message.angular.z)
        if not command.is_finite():
            rospy.logwarn_throttle(1.0, f"{self._name}: velocity command is not finite: the robot stops")
        self._command = command

    def _on_reset_odometry(self, _message):
        self._orders.leave(lambda: self._scene.robot(self._name).reset_odometry())

    def _joint_state_msg(self, observation: Observation, stamp) -> JointState:
        """Joints that do not move are at zero."""
        driven = self._profile.drive.joints
        angles = dict(zip(driven, observation.wheel_angles))
        speeds = dict(zip(driven, observation.wheel_speeds))
        message = JointState()
        message.header.stamp = stamp
        message.header.frame_id = self._frame("base_link")
        message.name = list(self._profile.joint_states.joints)
        message.position = [angles.get(joint, 0.0) for joint in message.name]
        message.velocity = [speeds.get(joint, 0.0) for joint in message.name]
        return message


def _odometry_msg(base: Pose2, twist: Twist2, stamp, frame: str, base_frame: str) -> Odometry:
    message = Odometry()
    message.header.stamp = stamp
    message.header.frame_id = frame
    message.child_frame_id = base_frame
    message.pose.pose = pose2_to_msg(base)
    message.twist.twist.linear.x = twist.v
    message.twist.twist.angular.z = twist.omega
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
    message.intensities = scan.intensities
    return message
