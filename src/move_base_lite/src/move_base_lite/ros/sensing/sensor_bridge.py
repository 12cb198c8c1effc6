"""Sensor bridge: passes odometry, scans and clouds on to MoveBase as stamped values."""

from functools import partial
from typing import Callable, List

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud, PointCloud2

from move_base_lite.costmap.layers.obstacles import SourceSettings
from move_base_lite.move_base import Measurement, MoveBase, SensorData
from move_base_lite.ros.sensing.checks import check_message
from move_base_lite.ros.sensing.clouds import points_of
from planar import Pose2
from planar_ros.messages.conversion import (
    LaserScanArrays,
    frame_name,
    pose2_from_msg,
    scan_from_msg,
    twist2_from_msg,
)
from planar_ros.messages.validation import subscribe

QUEUE_SIZE = 5
MESSAGES = {"LaserScan": LaserScanArrays, "PointCloud": PointCloud, "PointCloud2": PointCloud2}


class SensorBridge:
    """Subscribes to odometry and the observation sources of a MoveBase.

    Args:
        move_base: Receives the inputs.
        odom_topic: Topic of the odometry.
    """

    def __init__(self, move_base: MoveBase, odom_topic: str):
        self._move_base, self._inputs = move_base, move_base.inputs
        subscribe(odom_topic, Odometry, self._on_odometry, queue_size=1, tcp_nodelay=True)
        self._sensors = [_Sensor(source, move_base) for source in self._inputs.sources.values()]

    def has_message(self, topic: str) -> bool:
        """Whether all sensors on a topic have sent a message."""
        sources = self._inputs.sources
        return all(
            self._inputs.has_measurement(source) for source in sources if rospy.resolve_name(source) == topic
        )

    @property
    def topics(self) -> List[str]:
        """Topics of all observation sources."""
        return [rospy.resolve_name(topic) for topic in self._inputs.sources]

    def _on_odometry(self, message):
        stamp = message.header.stamp.to_sec() or rospy.get_time()
        pose, twist = pose2_from_msg(message.pose.pose), twist2_from_msg(message.twist.twist)
        self._move_base.add_odometry(stamp, pose, twist)


class _Sensor:
    """One observation source, whose messages are converted when a tick needs them."""

    def __init__(self, source: SourceSettings, move_base: MoveBase):
        self._source, self._move_base = source, move_base
        message_class = MESSAGES[source.data_type]
        subscribe(source.topic, message_class, self._on_message, queue_size=QUEUE_SIZE, tcp_nodelay=True)

    def _on_message(self, message):
        check_message(message)
        stamp, frame = message.header.stamp.to_sec(), frame_name(message.header.frame_id)
        if self._source.data_type == "LaserScan":
            read: Callable[[], SensorData] = partial(scan_from_msg, message, Pose2())
            measurement = Measurement(self._source.topic, stamp, read, frame, message)
        else:
            measurement = Measurement(self._source.topic, stamp, partial(points_of, message), frame)
        self._move_base.inputs.add(measurement)
