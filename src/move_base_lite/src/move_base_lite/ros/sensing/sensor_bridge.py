"""Sensor bridge: passes odometry, scans and clouds on to MoveBase as stamped values."""

from functools import partial
from typing import Dict, List, Optional

import numpy as np
import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud, PointCloud2

from move_base_lite.costmap import Observation, observation_from_points, observation_from_scan
from move_base_lite.costmap.layers.obstacles import SourceSettings
from move_base_lite.move_base import Measurement, MoveBase
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
from planar_ros.messages.transforms import Transforms
from planar_ros.messages.validation import WARN_SECONDS, subscribe

QUEUE_SIZE = 5
MESSAGES = {"LaserScan": LaserScanArrays, "PointCloud": PointCloud, "PointCloud2": PointCloud2}


class SensorBridge:
    """Subscribes to odometry and the observation sources of a MoveBase.

    Args:
        move_base: Receives the inputs.
        transforms: Transforms from tf.
        odom_topic: Topic of the odometry.
    """

    def __init__(self, move_base: MoveBase, transforms: Transforms, odom_topic: str):
        self._move_base, self._inputs = move_base, move_base.inputs
        subscribe(odom_topic, Odometry, self._on_odometry, queue_size=1, tcp_nodelay=True)
        base_frame = self._inputs.frames[-1]
        self._sensors = [
            _Sensor(source, transforms, base_frame, move_base) for source in self._inputs.sources.values()
        ]

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

    def __init__(self, source: SourceSettings, transforms: Transforms, base_frame: str, move_base: MoveBase):
        self._source, self._transforms = source, transforms
        self._base_frame, self._move_base = base_frame, move_base
        self._mountings: Dict[str, np.ndarray] = {}
        message_class = MESSAGES[source.data_type]
        subscribe(source.topic, message_class, self._on_message, queue_size=QUEUE_SIZE, tcp_nodelay=True)

    def _on_message(self, message):
        check_message(message)
        scan = message if self._source.data_type == "LaserScan" else None
        stamp, observe = message.header.stamp.to_sec(), partial(self._observe, message)
        self._move_base.inputs.add(Measurement(self._source.topic, stamp, observe, scan))

    def _observe(self, message) -> Optional[Observation]:
        """Convert a message; None, with a warning, while the mounting of its sensor is unknown."""
        frame = frame_name(self._source.sensor_frame or message.header.frame_id)
        if frame not in self._mountings:
            mounting = self._transforms.matrix(self._base_frame, frame)
            if mounting is None:
                topic = rospy.resolve_name(self._source.topic)
                text = f"{topic}: no transform from its frame '{frame}' to {self._base_frame}"
                rospy.logwarn_throttle(WARN_SECONDS, text)
                return None
            self._mountings[frame] = mounting
        return self._convert(message, self._mountings[frame])

    def _convert(self, message, sensor_in_base: np.ndarray) -> Observation:
        x, y, height = sensor_in_base[:3, 3]
        yaw = float(np.arctan2(sensor_in_base[1, 0], sensor_in_base[0, 0]))
        if self._source.data_type == "LaserScan":
            upside_down = bool(sensor_in_base[2, 2] < 0.0)
            scan = scan_from_msg(message, Pose2(float(x), float(y), yaw), upside_down)
            return observation_from_scan(self._source.topic, scan, float(height))
        return observation_from_points(
            self._source.topic,
            message.header.stamp.to_sec(),
            Pose2(float(x), float(y)),
            points_of(message),
            float(height),
            sensor_in_base,
        )
