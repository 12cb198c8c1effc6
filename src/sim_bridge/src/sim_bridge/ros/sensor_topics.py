"""Topics of sensors: their contract, and which a sensor of a robot's description has."""

from typing import Any, Callable, Dict, List, Protocol, Tuple

import rospy
from home_service_msgs.msg import DetectedObjects
from kobuki_msgs.msg import DockInfraRed
from sensor_msgs.msg import Imu

from planar import Scan
from planar_ros.messages.conversion import LaserScanArrays, time_of
from sim_bridge.robot import Robot, StepResult
from sim_bridge.ros.camera_topics import CameraTopics
from sim_bridge.ros.kobuki.topics import KobukiTopics
from sim_bridge.ros.publishers import RobotPublishers
from sim_bridge.ros.sensor_messages import detections_to_msg, dock_ir_to_msg, imu_to_msg, scan_to_msg
from sim_bridge.sensors.camera import CameraProfile
from sim_bridge.sensors.dock_ir import DockIrProfile
from sim_bridge.sensors.imu import ImuProfile
from sim_bridge.sensors.kobuki import KobukiProfile
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.sensors.object_detector import ObjectDetectorProfile


class SensorTopics(Protocol):
    """Topics of one sensor, made from its spec and the robot's publishers."""

    def has_subscribers(self) -> bool:
        """Return whether there are subscribers; a sensor on demand measures only while there are."""

    def publish(self, value: Any, stamp: rospy.Time) -> None:
        """Publish a measurement on the topics that have subscribers.

        Args:
            value: The measurement, of the sensor's type.
            stamp: Time of the measurement.
        """


class SingleTopic:
    """Publishes the measurements of a sensor that has one topic.

    Args:
        spec: Spec of the sensor, with ``topic`` and ``frame``.
        publishers: Publishers of the robot.
        kind: Type of the messages.
        to_msg: Converts a measurement and the spec to a message; the header is set afterwards.
        queue_size: Number of messages that wait for a slow subscriber.
    """

    def __init__(
        self,
        spec: Any,
        publishers: RobotPublishers,
        kind: type,
        to_msg: Callable[[Any, Any], Any],
        queue_size: int,
    ):
        self._spec = spec
        self._to_msg = to_msg
        self._frame = publishers.frame(spec.frame)
        self._publisher = publishers.publisher(spec.topic, kind, queue_size)

    def has_subscribers(self) -> bool:
        return self._publisher.get_num_connections() > 0

    def publish(self, value: Any, stamp: rospy.Time) -> None:
        """Publish a measurement if there are subscribers.

        Args:
            value: The measurement, of the sensor's type.
            stamp: Time of the measurement.
        """
        if self.has_subscribers():
            message = self._to_msg(value, self._spec)
            message.header.stamp, message.header.frame_id = stamp, self._frame
            self._publisher.publish(message)


def one_topic(
    kind: type, to_msg: Callable[[Any, Any], Any], queue_size: int = 10
) -> Callable[[Any, RobotPublishers], SensorTopics]:
    """Return a factory of SingleTopic.

    Args:
        kind: Type of the messages.
        to_msg: Converts a measurement and the spec to a message; the header is set afterwards.
        queue_size: Number of messages that wait for a slow subscriber.
    """
    return lambda spec, publishers: SingleTopic(spec, publishers, kind, to_msg, queue_size)


# Factories of topics by the class of a sensor's spec (see sim_bridge.sensors.registry).
TOPICS: Dict[type, Callable[[Any, RobotPublishers], SensorTopics]] = {
    LaserProfile: one_topic(LaserScanArrays, scan_to_msg),
    CameraProfile: CameraTopics,
    ImuProfile: one_topic(Imu, imu_to_msg, queue_size=100),
    KobukiProfile: KobukiTopics,
    ObjectDetectorProfile: one_topic(DetectedObjects, detections_to_msg),
    DockIrProfile: one_topic(DockInfraRed, dock_ir_to_msg),
}


class RobotSensorTopics:
    """Topics of all sensors of a robot's description.

    Args:
        robot: The robot.
        publishers: Its publishers.
    """

    def __init__(self, robot: Robot, publishers: RobotPublishers):
        self._robot = robot
        self._topics: List[Tuple[str, SensorTopics]] = [
            (name, TOPICS[type(spec)](spec, publishers))
            for name, spec in robot.specs.items()
            if type(spec) in TOPICS
        ]

    def enable_subscribed(self) -> None:
        """Enable the sensors on demand that have subscribers; to be called before a step."""
        for name, topics in self._topics:
            self._robot.enable_sensor(name, topics.has_subscribers())

    def publish(self, observation: StepResult) -> None:
        """Publish the readings of a step."""
        for name, topics in self._topics:
            reading = observation.readings.get(name)
            if reading is not None:
                # A scan has its own stamp, which faults may shift.
                stamp = reading.value.stamp if isinstance(reading.value, Scan) else reading.stamp
                topics.publish(reading.value, time_of(max(stamp, 0.0)))
