"""Topics and transforms of a robot."""

from typing import List, Optional, Tuple

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from planar import Twist2
from planar_ros.messages.conversion import time_of
from sim_bridge.description.profile import JointStateProfile
from sim_bridge.robot import StepResult
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.command_topics import CommandTopics, MuxTopics
from sim_bridge.ros.kobuki.commands import KobukiCommands
from sim_bridge.ros.messages import covariance_of
from sim_bridge.ros.motion_messages import OdometryMsg, TransformMsg
from sim_bridge.ros.power_topics import PowerTopics
from sim_bridge.ros.publishers import CountingPublisher, RobotPublishers
from sim_bridge.ros.sensor_topics import RobotSensorTopics
from sim_bridge.scene import Scene
from sim_bridge.sensors.base import Reading
from sim_bridge.sensors.kobuki import KobukiProfile
from sim_bridge.sensors.odometry import Odometer

# The frame of the world file; it coincides with a map made or rendered of that world.
WORLD_FRAME = "world"
# Queue of the ground truth: a referee that is delayed needs every message for its verdict and the run's hash.
TRUTH_QUEUE = 1000


class RobotTopics:
    """Publishes a robot's readings and subscribes to its commands.

    Args:
        scene: The simulated world.
        name: Name of the robot's model.
        calls: Queue of the thread that owns the scene.
        joint_steps: Steps between two joint states, if the robot's description has no rate.
        namespace: Namespace of the topics.
        tf_prefix: Prefix of the frames.
    """

    def __init__(
        self, scene: Scene, name: str, calls: CallQueue, joint_steps: int, namespace: str, tf_prefix: str
    ):
        self._scene = scene
        self._profile = profile = scene.robot(name).profile
        self._publishers = publishers = RobotPublishers(namespace, tf_prefix)
        is_kobuki = bool(profile.sensors_of(KobukiProfile))
        self._steps = 0
        self._odom_steps = self._steps_of(profile.odometry.rate, 1)
        self._contacts: Optional[Tuple[str, ...]] = None
        self._odom = publishers.publisher(profile.odometry.topic, Odometry, 100)
        self._truth = publishers.publisher("base_pose_ground_truth", Odometry, TRUTH_QUEUE)
        base_frame = publishers.frame(profile.odometry.base_frame)
        odom_frame = publishers.frame(profile.odometry.frame)
        self._odom_msg = OdometryMsg(odom_frame, base_frame, covariance_of(profile.odometry.variances))
        self._truth_msg = OdometryMsg(WORLD_FRAME, base_frame, [0.0] * 36)
        self._transform = TransformMsg(odom_frame, base_frame)
        self._sensors = RobotSensorTopics(scene.robot(name), publishers)
        battery = profile.battery
        self._power = PowerTopics(battery, publishers, is_kobuki) if battery is not None else None
        self._contacts_topic = publishers.publisher("contacts", String, latch=True)
        if profile.joint_states is not None:
            self._joints = publishers.publisher(profile.joint_states.topic, JointState)
            self._joint_steps = self._steps_of(profile.joint_states.rate, joint_steps)
        commands = MuxTopics if is_kobuki else CommandTopics
        self._commands = commands(name, namespace, profile.drive.command_topics)
        self._kobuki = KobukiCommands(scene, name, namespace, calls) if is_kobuki else None

    @property
    def odometry_seconds(self) -> float:
        """Time between two odometry messages [simulated s]."""
        return self._odom_steps * self._scene.step_seconds

    @property
    def commands_received(self) -> int:
        """Number of velocity commands received."""
        return self._commands.received

    def skip(self, count: int) -> None:
        """Keep the rates in step with time, as ``count`` steps of the scene are skipped."""
        self._steps += count

    def pop_command(self) -> Optional[Twist2]:
        """Return the command received since the last call, if any; to be called before a step."""
        self._sensors.enable_subscribed()
        return self._commands.pop(self._scene.stamp)

    def count_step(self) -> None:
        """Count a step; to be called before its results are published."""
        self._steps += 1

    def publish_sensors(self, observation: StepResult) -> None:
        """Publish the readings of a step except odometry."""
        stamp = time_of(observation.stamp)
        joint_states = self._profile.joint_states
        if joint_states is not None and self._joints_are_due():
            self._joints.publish(self._joint_state_msg(joint_states, observation, stamp))
        if observation.contacts != self._contacts:
            self._contacts = observation.contacts
            self._contacts_topic.publish("\n".join(observation.contacts))
        self._sensors.publish(observation)
        if self._power is not None and observation.power is not None:
            self._power.publish(observation.power, stamp)
        for text in self._scene.view.warnings:
            rospy.logwarn_once(text)

    def publish_motion(self, observation: StepResult) -> List[TransformMsg]:
        """Publish odometry and ground truth if they are due, and return the transforms."""
        if self._steps % self._odom_steps:
            return []
        transforms = self._publish_odometry(observation.readings.get(Odometer.name))
        if self._truth.get_num_connections():
            self._truth_msg.fill(observation.base_in_world, observation.twist, time_of(observation.stamp))
            self._truth.publish(self._truth_msg)
        return transforms

    def publishers(self) -> List[CountingPublisher]:
        """Return the publishers of all topics of the robot."""
        return self._publishers.publishers

    def close(self) -> None:
        """Unregister all topics."""
        self._publishers.close()
        self._commands.close()
        if self._kobuki is not None:
            self._kobuki.close()

    def _publish_odometry(self, reading: Optional[Reading]) -> List[TransformMsg]:
        if reading is None:
            return []
        odometry, stamp = reading.value, time_of(reading.stamp)
        if self._odom.get_num_connections():
            self._odom_msg.fill(odometry.base_in_odom, odometry.twist, stamp)
            self._odom.publish(self._odom_msg)
        if not self._profile.odometry.sends_transform:
            return []
        self._transform.fill(odometry.base_in_odom, stamp)
        return [self._transform]

    def _steps_of(self, rate: Optional[float], default: int) -> int:
        """Return the steps of the scene between two messages of a rate [Hz]."""
        return default if rate is None else max(round(1.0 / self._scene.step_seconds / rate), 1)

    def _joints_are_due(self) -> bool:
        return self._steps % self._joint_steps == 0 and self._joints.get_num_connections() > 0

    def _joint_state_msg(
        self, profile: JointStateProfile, observation: StepResult, stamp: rospy.Time
    ) -> JointState:
        """Make the state of all joints; those that are not driven are at 0."""
        driven = self._profile.drive.joints
        angles = dict(zip(driven, observation.wheel_angles))
        speeds = dict(zip(driven, observation.wheel_speeds))
        message = JointState()
        message.header.stamp = stamp
        message.header.frame_id = self._publishers.frame("base_link")
        message.name = list(profile.joints)
        message.position = [angles.get(joint, 0.0) for joint in message.name]
        message.velocity = [speeds.get(joint, 0.0) for joint in message.name]
        return message
