"""A robot's topics and transforms."""

from typing import List, Optional

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from planar import Scan, Twist2
from planar_ros.messages.conversion import LaserScanArrays, time_of
from sim_bridge.robot import Observation
from sim_bridge.ros.command_topics import CommandTopics, MuxTopics
from sim_bridge.ros.kobuki_topics import KobukiTopics
from sim_bridge.ros.messages import covariance_of
from sim_bridge.ros.motion_messages import OdometryMsg, TransformMsg
from sim_bridge.ros.orders import Orders
from sim_bridge.ros.performance import CountingPublisher
from sim_bridge.ros.sensor_topics import SensorTopics
from sim_bridge.scene import Scene

# The frame of the world file; it coincides with a map made or rendered of that world.
WORLD_FRAME = "world"


class RobotTopics:
    """Tells what a robot observes and takes its commands; its topics are below ``namespace``.

    ``tf_prefix`` is put before the names of its frames. ``joint_steps``: steps between two states of the
    joints, if the robot does not say how many.
    """

    def __init__(
        self, scene: Scene, name: str, orders: Orders, joint_steps: int, namespace: str, tf_prefix: str
    ):
        self._scene = scene
        self._profile = profile = scene.robot(name).profile
        self._namespace = namespace
        self._tf_prefix = f"{tf_prefix}/" if tf_prefix else ""
        self._steps = 0
        self._odom_steps = self._steps_of(profile.odometry.rate, 1)
        self._contacts = None
        self._publishers: List[CountingPublisher] = []
        self._odom = self._publisher(profile.odometry.topic, Odometry, 100)
        self._truth = self._publisher("base_pose_ground_truth", Odometry, 100)
        base_frame, odom_frame = self._frame(profile.odometry.base_frame), self._frame(profile.odometry.frame)
        self._odom_msg = OdometryMsg(odom_frame, base_frame, covariance_of(profile.odometry.variances))
        self._truth_msg = OdometryMsg(WORLD_FRAME, base_frame, [0.0] * 36)
        self._transform = TransformMsg(odom_frame, base_frame)
        self._scans = [self._publisher(laser.topic, LaserScanArrays) for laser in profile.lasers]
        self._sensors = SensorTopics(scene, name, self._publisher, self._frame)
        self._touches = self._publisher("contacts", String, latch=True)
        if profile.joint_states is not None:
            self._joints = self._publisher(profile.joint_states.topic, JointState)
            self._joint_steps = self._steps_of(profile.joint_states.rate, joint_steps)
        is_kobuki = profile.kobuki is not None
        commands = MuxTopics if is_kobuki else CommandTopics
        self._commands = commands(name, namespace, profile.drive.command_topics)
        self._kobuki = KobukiTopics(scene, name, namespace, orders, self._frame) if is_kobuki else None

    @property
    def odometry_seconds(self) -> float:
        """Simulated seconds between two messages of odometry."""
        return self._odom_steps * self._scene.step_seconds

    def take_command(self) -> Optional[Twist2]:
        """The command that has come since the last call, if any."""
        return self._commands.take(self._scene.stamp)

    def publish(self, observation: Observation) -> List[TransformMsg]:
        """Tells what was observed, but for the transforms, which it returns."""
        self._steps += 1
        stamp = time_of(observation.stamp)
        for publisher, laser, scan in zip(self._scans, self._profile.lasers, observation.scans):
            if scan is not None and publisher.get_num_connections():
                publisher.publish(_scan_msg(scan, self._frame(laser.frame), laser.scan_time))
        joints_are_due = self._profile.joint_states is not None and self._steps % self._joint_steps == 0
        if joints_are_due and self._joints.get_num_connections():
            self._joints.publish(self._joint_state_msg(observation, stamp))
        if observation.contacts != self._contacts:
            self._contacts = observation.contacts
            self._touches.publish("\n".join(observation.contacts))
        self._sensors.publish(self._steps, stamp)
        if self._kobuki is not None and observation.kobuki is not None:
            self._kobuki.publish(observation.kobuki, stamp)
        if self._steps % self._odom_steps:
            return []
        return self._publish_motion(observation, stamp)

    def publishers(self) -> List[CountingPublisher]:
        """Of all topics of the robot."""
        return self._publishers

    def close(self) -> None:
        """Ends the topics."""
        for publisher in self._publishers:
            publisher.unregister()
        self._commands.close()
        if self._kobuki is not None:
            self._kobuki.close()

    def _publish_motion(self, observation: Observation, stamp) -> List[TransformMsg]:
        odometry = observation.odometry
        for publisher, message, base, twist in (
            (self._odom, self._odom_msg, odometry.base_in_odom, odometry.twist),
            (self._truth, self._truth_msg, observation.base_in_world, observation.twist),
        ):
            if publisher.get_num_connections():
                message.fill(base, twist, stamp)
                publisher.publish(message)
        if not self._profile.odometry.sends_transform:
            return []
        self._transform.fill(odometry.base_in_odom, stamp)
        return [self._transform]

    def _steps_of(self, rate: Optional[float], default: int) -> int:
        """Steps of the scene between two messages that come ``rate`` times a second."""
        return default if rate is None else max(round(1.0 / self._scene.step_seconds / rate), 1)

    def _publisher(self, topic, kind, queue_size=10, latch=False):
        name = rospy.names.ns_join(self._namespace, topic)
        publisher = CountingPublisher(name, kind, queue_size=queue_size, latch=latch, tcp_nodelay=True)
        self._publishers.append(publisher)
        return publisher

    def _frame(self, name: str) -> str:
        return self._tf_prefix + name.lstrip("/")

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


def _scan_msg(scan: Scan, frame: str, scan_time: float) -> LaserScanArrays:
    message = LaserScanArrays()
    message.header.stamp = time_of(scan.stamp)
    message.header.frame_id = frame
    message.angle_min = scan.angle_min
    message.angle_increment = scan.angle_increment
    message.angle_max = scan.angle_min + scan.angle_increment * (len(scan.ranges) - 1)
    message.scan_time = scan_time
    message.range_min, message.range_max = scan.range_min, scan.range_max
    message.ranges = scan.ranges
    message.intensities = scan.intensities
    return message
