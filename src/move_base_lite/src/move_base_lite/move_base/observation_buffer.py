"""Buffer of one observation source: data wait for their transforms (costmap_2d: ObservationBuffer)."""

from collections import deque
from dataclasses import dataclass, replace
from typing import Any, Callable, Deque, NamedTuple, Optional

from move_base_lite.costmap import Observation, observation_from_scan
from move_base_lite.move_base.placement import SensorData, SensorPlacement
from move_base_lite.move_base.robot_poses import RobotPoses
from move_base_lite.navigator.inputs import RobotState
from planar import Scan

# Messages that wait for their transforms (tf2_ros: MessageFilter of costmap_2d), and for how long [s].
QUEUE_SIZE, TRANSFORM_PATIENCE = 50, 2.0
# Shortest time between complaints about a source [s].
COMPLAINT_PERIOD = 10.0


@dataclass(frozen=True, eq=False)
class Measurement:
    """One message of an observation source.

    Attributes:
        topic: Topic of the source, as in the settings.
        stamp: Time of the measurement [s]; 0 for the latest known pose.
        read: Returns the data: points (N, 3) or a scan in ``frame``.
        frame: Frame of the data; None for a scan that contains its mounting pose.
        scan: Scan to check for plausibility: ``ranges``, ``range_min``, ``range_max`` and
            ``angle_increment``; None for point clouds.
        height: Height of a laser that contains its mounting pose above the floor [m].
    """

    topic: str
    stamp: float
    read: Callable[[], SensorData]
    frame: Optional[str] = None
    scan: Any = None
    height: float = 0.0


class _Waiting(NamedTuple):
    measurement: Measurement
    since: float


class ObservationBuffer:
    """Returns the latest data of a source whose transforms at their stamp are known.

    Args:
        poses: Poses of the robot and of its sensors.
        name: Name of the topic for messages to people.
        sensor_frame: Frame from which rays begin; empty for the frame of the data.

    Attributes:
        is_level: Whether the latest scan was level, so that motion changes its ranges.
    """

    def __init__(self, poses: RobotPoses, name: str, sensor_frame: str = ""):
        self._poses, self._name, self._origin = poses, name, sensor_frame.lstrip("/")
        self._new: Deque[Measurement] = deque(maxlen=QUEUE_SIZE)
        self._waiting: Deque[_Waiting] = deque(maxlen=QUEUE_SIZE)
        self._dropped, self._next_complaint, self._reason = 0, 0.0, ""
        self.is_level = True

    def add(self, measurement: Measurement) -> None:
        """Add data, which replace those that wait longest if too many do."""
        self._new.append(measurement)

    def newest(self, state: RobotState) -> Optional[Observation]:
        """Return the latest data whose transforms are known.

        Args:
            state: State of the robot.

        Returns:
            The data as seen from the present pose; None if there are none.
        """
        while self._new:
            self._waiting.append(_Waiting(self._new.popleft(), state.stamp))
        for measurement, _ in reversed(tuple(self._waiting)):
            observation = self._observe(measurement, state)
            if observation is not None:
                while self._waiting and self._waiting[0].measurement.stamp <= measurement.stamp:
                    self._waiting.popleft()
                return observation
        self._drop_overdue(state.stamp)
        return None

    def complaint(self, now: float) -> Optional[str]:
        """Describe data that were dropped for want of a transform.

        Args:
            now: Time of the tick [s].

        Returns:
            The description, at most every COMPLAINT_PERIOD; None if there is none.
        """
        if not self._dropped or now < self._next_complaint:
            return None
        count, self._dropped, self._next_complaint = self._dropped, 0, now + COMPLAINT_PERIOD
        messages = "message" if count == 1 else "messages"
        return f"{self._name}: {count} {messages} dropped after {TRANSFORM_PATIENCE:g} s: {self._reason}"

    def _drop_overdue(self, now: float) -> None:
        """Drop data that have waited too long for a transform."""
        while self._waiting and not 0.0 <= now - self._waiting[0].since <= TRANSFORM_PATIENCE:
            measurement = self._waiting.popleft().measurement
            self._dropped += 1
            frames = [frame for frame in (measurement.frame, self._origin) if frame]
            self._reason = self._poses.missing_transform(frames, measurement.stamp)

    def _observe(self, measurement: Measurement, state: RobotState) -> Optional[Observation]:
        base_at_stamp = self._poses.base_in_odom(measurement.stamp)
        observation = None if base_at_stamp is None else self._observe_at_stamp(measurement)
        if observation is None or base_at_stamp is None or measurement.stamp == state.stamp:
            return observation
        moved = state.base_in_odom.inverse() @ base_at_stamp
        return replace(observation, sensor_in_base=moved @ observation.sensor_in_base)

    def _observe_at_stamp(self, measurement: Measurement) -> Optional[Observation]:
        if measurement.frame is None:
            scan = measurement.read()
            assert isinstance(scan, Scan)
            return observation_from_scan(measurement.topic, scan, measurement.height)
        placement = self._placement(measurement.frame, measurement.stamp)
        if placement is None:
            return None
        if measurement.scan is not None:
            self.is_level = placement.is_level
        return placement.observe(measurement.topic, measurement.stamp, measurement.read())

    def _placement(self, frame: str, stamp: float) -> Optional[SensorPlacement]:
        base_in_odom = self._poses.base_in_space(stamp)
        frame_in_base = self._poses.frame_in_base(frame, stamp)
        if base_in_odom is None or frame_in_base is None:
            return None
        if self._origin in ("", frame):
            return SensorPlacement(base_in_odom, frame_in_base)
        origin_in_base = self._poses.frame_in_base(self._origin, stamp)
        if origin_in_base is None:
            return None
        return SensorPlacement(base_in_odom, frame_in_base, origin_in_base)
