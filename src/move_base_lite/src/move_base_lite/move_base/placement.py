"""Placement of sensor data: in the frame of their header, at their stamp (costmap_2d: ObservationBuffer)."""

import math
from dataclasses import dataclass, replace
from typing import Optional, Union

import numpy as np

from move_base_lite.costmap import (
    Observation,
    observation_from_points,
    observation_from_projected_scan,
    observation_from_scan,
)
from planar import Pose2, Scan

# Inclination up to which a laser counts as level [rad]: descriptions round pi to 3.14.
LEVEL_ANGLE = 0.002
# Deviation of the base's vertical axis and height up to which it stands flat on the floor.
FLAT_TOLERANCE = 1e-9
# Points of a cloud, (N, 3) [m], or a scan without its mounting pose.
SensorData = Union[Scan, np.ndarray]


@dataclass(frozen=True, eq=False)
class SensorPlacement:
    """Poses at the stamp of sensor data, as matrices (4, 4).

    Attributes:
        base_in_odom: The base, with height, roll and pitch.
        frame_in_base: The frame of the data.
        origin_in_base: The frame from which rays begin; None for that of the data.
    """

    base_in_odom: np.ndarray
    frame_in_base: np.ndarray
    origin_in_base: Optional[np.ndarray] = None

    @property
    def is_level(self) -> bool:
        """Whether the data's xy plane is parallel to the floor."""
        return abs(self._above_floor(self.frame_in_base)[2, 2]) >= math.cos(LEVEL_ANGLE)

    def observe(self, topic: str, stamp: float, data: SensorData) -> Observation:
        """Convert data to a costmap observation.

        Args:
            topic: Topic of the data.
            stamp: Time of the measurement [s].
            data: A scan without its mounting pose, or points, both in the frame of the data.

        Returns:
            The observation; heights are above the floor, the xy plane of odometry.
        """
        frame = self._above_floor(self.frame_in_base)
        origin = frame if self.origin_in_base is None else self._above_floor(self.origin_in_base)
        if not isinstance(data, Scan):
            x, y, height = map(float, origin[:3, 3])
            return observation_from_points(topic, stamp, Pose2(x, y), data, height, frame)
        if self.origin_in_base is None and self.is_level:
            scan = replace(data, laser_in_base=_planar(frame), upside_down=bool(frame[2, 2] < 0.0))
            return observation_from_scan(topic, scan, float(frame[2, 3]))
        return observation_from_projected_scan(topic, data, frame, origin[:3, 3])

    def _above_floor(self, pose_in_base: np.ndarray) -> np.ndarray:
        """Return a pose relative to the base's position and yaw on the floor."""
        if np.abs(self.base_in_odom[2] - (0.0, 0.0, 1.0, 0.0)).max() < FLAT_TOLERANCE:
            return pose_in_base
        on_floor = _planar(self.base_in_odom).as_matrix()
        return np.linalg.inv(on_floor) @ self.base_in_odom @ pose_in_base


def _planar(pose: np.ndarray) -> Pose2:
    return Pose2(float(pose[0, 3]), float(pose[1, 3]), float(np.arctan2(pose[1, 0], pose[0, 0])))
