"""Sensor bridge: converts scans and clouds to costmap observations, collects transforms and odometry."""

import threading
from collections import deque
from dataclasses import dataclass, replace
from typing import Callable, Deque, Dict, List, Optional, Tuple

import numpy as np
import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud, PointCloud2

from move_base_lite.config import NavigatorSettings
from move_base_lite.costmap import Observation, observation_from_points, observation_from_scan
from move_base_lite.costmap.layers.obstacles import SourceSettings
from move_base_lite.plausibility import SensorMonitor
from move_base_lite.ros.sensing.checks import check_message
from move_base_lite.ros.sensing.clouds import points_of
from move_base_lite.ros.sensing.diagnostics import SensorDiagnostics
from planar import Pose2, Twist2
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
# A sensor without messages for so long [s], which stopped about when localization did, may be the cause.
SILENT_SECONDS = 2.0
MESSAGES = {"LaserScan": LaserScanArrays, "PointCloud": PointCloud, "PointCloud2": PointCloud2}


@dataclass(frozen=True)
class NavigatorInputs:
    """Inputs of the Navigator at a control tick.

    Attributes:
        base_in_map: Robot pose in the map frame.
        base_in_odom: Robot pose in the odometry frame.
        twist: Velocity from odometry.
        observations: Sensor data since the last tick, transformed to the present pose.
    """

    base_in_map: Pose2
    base_in_odom: Pose2
    twist: Twist2
    observations: Tuple[Observation, ...]


class SensorBridge:
    """Stores messages in callbacks; ``inputs`` combines them at a tick.

    Args:
        settings: Frames, transform tolerances and observation sources.
        transforms: Transforms from tf.
        odom_topic: Topic of the odometry.
    """

    def __init__(self, settings: NavigatorSettings, transforms: Transforms, odom_topic: str):
        self._transforms = transforms
        self._global_frame = frame_name(settings.global_costmap.global_frame)
        self._local_frame = frame_name(settings.local_costmap.global_frame)
        self._base_frame = frame_name(settings.local_costmap.robot_base_frame)
        self.update_settings(settings)
        self._twist = Twist2()
        self._command = Twist2()
        self._monitor = SensorMonitor()
        self._fault: Optional[str] = None
        self._diagnostics = SensorDiagnostics()
        self._lock = threading.Lock()
        subscribe(odom_topic, Odometry, self._on_odometry, queue_size=1, tcp_nodelay=True)
        self._sensors = [
            _Sensor(source, transforms, self._local_frame, self._base_frame, self._on_scan)
            for source in _sources_of(settings).values()
        ]

    def update_settings(self, settings: NavigatorSettings) -> None:
        """Apply other transform tolerances."""
        costmaps = (settings.global_costmap, settings.local_costmap)
        self._tolerances = tuple(costmap.transform_tolerance for costmap in costmaps)

    def has_message(self, topic: str) -> bool:
        """Whether all sensors on a topic have sent a message."""
        return all(sensor.has_message for sensor in self._sensors if sensor.topic == topic)

    @property
    def topics(self) -> List[str]:
        """Topics of all observation sources."""
        return [sensor.topic for sensor in self._sensors]

    def inputs(self, now: rospy.Time) -> Optional[NavigatorInputs]:
        """Combine the inputs of a control tick.

        Args:
            now: Time of the tick.

        Returns:
            The inputs; None without valid transforms, or with a sensor fault.
        """
        if self.missing_transform(now) is not None:
            self.set_command(Twist2())  # the robot stands while its pose is unknown
            return None
        base_in_odom = self._transforms.lookup(self._local_frame, self._base_frame)
        odom_in_map = self._transforms.lookup(self._global_frame, self._local_frame)
        if base_in_odom is None or odom_in_map is None:
            return None
        newest = (sensor.newest(base_in_odom) for sensor in self._sensors)
        observations = tuple(observation for observation in newest if observation is not None)
        return NavigatorInputs(odom_in_map @ base_in_odom, base_in_odom, self._twist, observations)

    def set_command(self, command: Twist2) -> None:
        """Set the velocity command to compare sensors with; a stop because of a sensor fault is ignored.

        Args:
            command: Velocity command that the robot follows.
        """
        if self._fault is None:
            self._command = command

    def missing_transform(self, now: rospy.Time) -> Optional[str]:
        """Describe the transform that is missing or too old, or the sensor fault; None if there is none.

        Args:
            now: Time of the tick.
        """
        self._fault = fault = self._monitor.fault(now.to_sec())
        self._diagnostics.publish(fault, now)
        if fault is not None:
            return f"a trustworthy sensor ({fault})"
        # Odometry first: without it localization stops too, and would be reported instead.
        links = [(self._global_frame, self._local_frame), (self._local_frame, self._base_frame)]
        for (parent, child), tolerance in reversed(list(zip(links, self._tolerances))):
            latest = self._transforms.latest_stamp(parent, child)
            if latest is None:
                return f"the transform {parent} -> {child}"
            if parent != child and latest != rospy.Time(0) and (now - latest).to_sec() > tolerance:
                age = (now - latest).to_sec()
                silence = self._silence_since(latest, now) if parent == self._global_frame else ""
                return f"a transform {parent} -> {child} that is not {age:.1f} s old{silence}"
        return None

    def _silence_since(self, stamp: rospy.Time, now: rospy.Time) -> str:
        """Describe the sensor whose messages stopped when localization did; empty if there is none."""
        for sensor in self._sensors:
            silence, difference = (
                (now - sensor.last_message_at).to_sec(),
                abs((stamp - sensor.last_message_at).to_sec()),
            )
            if sensor.has_message and silence > SILENT_SECONDS > difference:
                return f"; nothing on {sensor.topic} for {silence:.1f} s"
        return ""

    def reset(self) -> None:
        """Discard all messages and transforms, since time has jumped back."""
        for sensor in self._sensors:
            sensor.reset()
        self._transforms.clear()
        self._monitor.reset()
        self._command, self._fault = Twist2(), None

    def _on_odometry(self, message):
        self._twist = twist2_from_msg(message.twist.twist)
        pose = pose2_from_msg(message.pose.pose)
        self._monitor.add_odometry(rospy.get_time(), pose, self._command)

    def _on_scan(self, message):
        span = message.angle_increment * (len(message.ranges) - 1)
        self._monitor.add_scan(message.ranges, message.range_min, message.range_max, span)


class _Sensor:
    """The latest messages of a topic, converted to observations as soon as their transform is known."""

    def __init__(
        self,
        source: SourceSettings,
        transforms: Transforms,
        local_frame: str,
        base_frame: str,
        on_scan: Callable[[LaserScanArrays], None],
    ):
        """Subscribe to the source.

        Args:
            source: Observation source.
            transforms: Transforms from tf.
            local_frame: Frame of the local costmap.
            base_frame: Frame of the robot.
            on_scan: Called for each scan of a source that marks.
        """
        self._source, self._on_scan = source, on_scan
        self._transforms = transforms
        self._local_frame, self._base_frame = local_frame, base_frame
        self._messages: Deque = deque(maxlen=QUEUE_SIZE)
        self._lock = threading.Lock()
        self._mountings: Dict[str, np.ndarray] = {}
        self.has_message, self.last_message_at = False, rospy.Time(0)
        subscribe(
            source.topic,
            MESSAGES[source.data_type],
            self._on_message,
            queue_size=QUEUE_SIZE,
            tcp_nodelay=True,
        )

    @property
    def topic(self) -> str:
        return rospy.resolve_name(self._source.topic)

    def newest(self, base_in_odom: Pose2) -> Optional[Observation]:
        """Convert the latest new message, relative to the present pose; None if there is none."""
        with self._lock:
            queued = list(self._messages)
        for message in reversed(queued):
            observation = self._observe(base_in_odom, message)
            if observation is None:
                self._warn_of_transform(message)
            else:
                with self._lock:
                    while self._messages and self._messages[0].header.stamp <= message.header.stamp:
                        self._messages.popleft()
                return observation
        return None

    def reset(self) -> None:
        with self._lock:
            self._messages.clear()

    def _warn_of_transform(self, message) -> None:
        """Warn if the transform to a message's frame is missing."""
        frame = frame_name(self._source.sensor_frame or message.header.frame_id)
        if frame not in self._mountings:
            rospy.logwarn_throttle(
                WARN_SECONDS, f"{self.topic}: no transform from its frame '{frame}' to {self._base_frame}"
            )

    def _on_message(self, message):
        check_message(message)
        self.has_message, self.last_message_at = True, rospy.Time.now()
        if self._source.data_type == "LaserScan" and self._source.marking:
            self._on_scan(message)
        with self._lock:
            self._messages.append(message)

    def _observe(self, base_in_odom: Pose2, message) -> Optional[Observation]:
        """Convert a message; None while the transform at its stamp is unknown."""
        frame = frame_name(self._source.sensor_frame or message.header.frame_id)
        base_at_stamp = self._transforms.lookup(self._local_frame, self._base_frame, message.header.stamp)
        if frame not in self._mountings:
            mounting = self._transforms.matrix(self._base_frame, frame)
            if mounting is None:
                return None
            self._mountings[frame] = mounting
        if base_at_stamp is None:
            return None
        sensor_in_base = self._mountings[frame]
        observation = self._convert(message, sensor_in_base)
        moved = base_in_odom.inverse() @ base_at_stamp
        return replace(observation, sensor_in_base=moved @ observation.sensor_in_base)

    def _convert(self, message, sensor_in_base: np.ndarray) -> Observation:
        x, y, height = sensor_in_base[:3, 3]
        yaw = float(np.arctan2(sensor_in_base[1, 0], sensor_in_base[0, 0]))
        if self._source.data_type == "LaserScan":
            upside_down = bool(sensor_in_base[2, 2] < 0.0)
            scan = scan_from_msg(message, Pose2(float(x), float(y), yaw), upside_down)
            return observation_from_scan(self._source.topic, scan, float(height))
        points = points_of(message) @ sensor_in_base[:3, :3].T + sensor_in_base[:3, 3]
        return observation_from_points(
            self._source.topic, message.header.stamp.to_sec(), Pose2(float(x), float(y)), points
        )


def _sources_of(settings: NavigatorSettings) -> Dict[str, SourceSettings]:
    """One source for each topic of the costmaps' observation sources."""
    costmaps = (settings.global_costmap, settings.local_costmap)
    return {source.topic: source for costmap in costmaps for source in costmap.obstacles.sources}
