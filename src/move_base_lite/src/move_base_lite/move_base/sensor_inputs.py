"""Sensor inputs of move_base: they are stored as they arrive, checked and combined at a control tick."""

import math
from collections import deque
from dataclasses import dataclass
from typing import Any, Callable, Deque, Dict, List, Optional

from move_base_lite.config import NavigatorSettings
from move_base_lite.costmap import Observation
from move_base_lite.costmap.layers.obstacles import SourceSettings
from move_base_lite.move_base.observation_buffer import Measurement, ObservationBuffer
from move_base_lite.move_base.robot_poses import RobotPoses
from move_base_lite.navigator.inputs import RobotState
from move_base_lite.plausibility import SensorMonitor
from planar import Pose2, Twist2

# Inputs that wait for a tick.
MOST_WAITING = 1000
# A sensor without messages for so long [s], which stopped about when localization did, may be the cause.
SILENT_SECONDS = 2.0


@dataclass(frozen=True)
class _Odometry:
    stamp: float
    base_in_odom: Pose2
    twist: Twist2


class SensorInputs:
    """Odometry and measurements since the last tick, and whether the robot may rely on them.

    Args:
        settings: Frames, transform tolerances and observation sources.
        poses: Poses of the robot.
        full_name: Returns the name of a topic for messages to people.
    """

    def __init__(
        self,
        settings: NavigatorSettings,
        poses: RobotPoses,
        full_name: Callable[[str], str] = lambda topic: topic,
    ):
        self._poses, self._full_name = poses, full_name
        costmaps = settings.global_costmap, settings.local_costmap
        map_frame, odom_frame = (costmap.global_frame.lstrip("/") for costmap in costmaps)
        self.frames = map_frame, odom_frame, settings.local_costmap.robot_base_frame.lstrip("/")
        self.update_settings(settings)
        self.sources: Dict[str, SourceSettings] = {
            source.topic: source for costmap in costmaps for source in costmap.sources
        }
        self.reset()
        self._latest_stamps: Dict[str, float] = {}

    def reset(self) -> None:
        """Discard all inputs, since time has jumped back."""
        self._waiting: Deque[Any] = deque(maxlen=MOST_WAITING)
        self._buffers: Dict[str, ObservationBuffer] = {}
        self._twist, self._monitor = Twist2(), SensorMonitor()

    def update_settings(self, settings: NavigatorSettings) -> None:
        """Apply other transform tolerances."""
        costmaps = settings.global_costmap, settings.local_costmap
        self._tolerances = tuple(costmap.transform_tolerance for costmap in costmaps)

    def add_odometry(self, stamp: float, base_in_odom: Pose2, twist: Twist2) -> None:
        """Add odometry; any thread may call this."""
        self._waiting.append(_Odometry(stamp, base_in_odom, twist))

    def add(self, measurement: Measurement) -> None:
        """Add a measurement; any thread may call this."""
        self._latest_stamps[measurement.topic] = measurement.stamp
        self._waiting.append(measurement)

    def has_measurement(self, topic: str) -> bool:
        """Whether a source has ever sent a measurement."""
        return topic in self._latest_stamps

    def check_new(self, commanded: Twist2) -> None:
        """Check what has arrived since the last tick, in the order of its stamps.

        Args:
            commanded: Velocity command that the robot has followed.
        """
        inputs = []
        while self._waiting:
            inputs.append(self._waiting.popleft())
        # At equal stamps odometry first, as the pose of the scan.
        for each in sorted(inputs, key=lambda each: (each.stamp, isinstance(each, Measurement))):
            if isinstance(each, Measurement):
                self._check_measurement(each)
            else:
                self._twist = each.twist
                self._monitor.add_odometry(each.stamp, each.base_in_odom, commanded)

    def _check_measurement(self, measurement: Measurement) -> None:
        scan, source = measurement.scan, self.sources.get(measurement.topic)
        buffer = self._buffer(measurement.topic)
        if scan is not None and buffer.is_level and (source is None or source.marking):
            span = scan.angle_increment * (len(scan.ranges) - 1)
            self._monitor.add_scan(scan.ranges, scan.range_min, scan.range_max, span)
        buffer.add(measurement)

    def _buffer(self, topic: str) -> ObservationBuffer:
        if topic not in self._buffers:
            source = self.sources.get(topic)
            sensor_frame = "" if source is None else source.sensor_frame
            self._buffers[topic] = ObservationBuffer(self._poses, self._full_name(topic), sensor_frame)
        return self._buffers[topic]

    def fault(self, now: float) -> Optional[str]:
        """Describe the sensor that contradicts the others or has stopped; None if there is none."""
        return self._monitor.fault(now)

    def missing(self, now: float) -> Optional[str]:
        """Describe the transform that is missing or too old; None if there is none.

        Args:
            now: Time of the tick [s].
        """
        map_frame, odom_frame, base_frame = self.frames
        map_tolerance, odom_tolerance = self._tolerances
        # Odometry first: without it localization stops too, and would be reported instead.
        latest = self._poses.odometry_stamp()
        complaint = _too_old(odom_frame, base_frame, latest, now, odom_tolerance)
        if complaint is None and map_frame != odom_frame:
            latest = self._poses.localization_stamp()
            complaint = _too_old(map_frame, odom_frame, latest, now, map_tolerance)
            if complaint is not None and latest is not None:
                complaint += self._silence_since(latest, now)
        return complaint

    def state(self, now: float) -> Optional[RobotState]:
        """Return the state of the robot; None if a pose is not known.

        Args:
            now: Time of the tick [s].
        """
        base_in_odom = self._poses.base_in_odom()
        odom_in_map = None if self.frames[0] == self.frames[1] else self._poses.odom_in_map()
        if base_in_odom is None or (odom_in_map is None and self.frames[0] != self.frames[1]):
            return None
        base_in_map = base_in_odom if odom_in_map is None else odom_in_map @ base_in_odom
        return RobotState(now, base_in_map, base_in_odom, self._twist)

    def observations(self, state: RobotState) -> List[Observation]:
        """Return the latest new measurement of each source, as seen from the present pose."""
        newest = (buffer.newest(state) for buffer in self._buffers.values())
        return [observation for observation in newest if observation is not None]

    def complaints(self, now: float) -> List[str]:
        """Describe sensor data that were dropped for want of a transform.

        Args:
            now: Time of the tick [s].
        """
        complaints = (buffer.complaint(now) for buffer in self._buffers.values())
        return [complaint for complaint in complaints if complaint]

    def _silence_since(self, stamp: float, now: float) -> str:
        """Describe the sensor whose messages stopped when localization did; empty if there is none."""
        for topic, latest in self._latest_stamps.items():
            silence, difference = now - latest, abs(stamp - latest)
            if silence > SILENT_SECONDS > difference:
                return f"; nothing on {self._full_name(topic)} for {silence:.1f} s"
        return ""


def _too_old(parent: str, child: str, latest: Optional[float], now: float, tolerance: float) -> Optional[str]:
    if latest is None:
        return f"the transform {parent} -> {child}"
    if math.isfinite(latest) and now - latest > tolerance:
        return f"a transform {parent} -> {child} that is not {now - latest:.1f} s old"
    return None
