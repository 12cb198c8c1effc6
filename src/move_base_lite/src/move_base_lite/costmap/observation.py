"""Costmap observation: a laser scan or point cloud as costmap layers use it (costmap_2d: Observation)."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Optional, Union

import numba
import numpy as np

from planar import Pose2, Scan


@dataclass(frozen=True, eq=False)
class Observation:
    """Beams of a laser scan, or beams to the points of a point cloud.

    A beam hits an obstacle if its range lies in [range_min, range_max).

    Attributes:
        topic: Topic of the message.
        stamp: Time of the measurement [s].
        sensor_in_base: Origin of the beams in the base frame.
        beam_angles: (N,) angles of the beams in the sensor frame [rad]; None if ``unit_vectors`` has them.
        ranges: (N,) ranges [m].
        range_min: Shortest valid range [m].
        range_max: Limit of valid ranges [m].
        heights: Heights of the end points above the floor [m], one for all or (N,).
        sensor_height: Height of the origin of the beams above the floor [m].
        unit_vectors: (N, 2) directions of the beams in the sensor frame; None if ``beam_angles`` has them.
    """

    topic: str
    stamp: float
    sensor_in_base: Pose2
    beam_angles: Optional[np.ndarray]
    ranges: np.ndarray
    range_min: float = 0.0
    range_max: float = np.inf
    heights: Union[float, np.ndarray] = 0.0
    sensor_height: float = 0.0
    unit_vectors: Optional[np.ndarray] = None

    @cached_property
    def angles(self) -> np.ndarray:
        """(N,) angles of the beams in the sensor frame [rad]."""
        if self.beam_angles is not None:
            return self.beam_angles
        return np.arctan2(self.directions_xy[:, 1], self.directions_xy[:, 0])

    @cached_property
    def directions_xy(self) -> np.ndarray:
        """(N, 2) unit vectors along the beams in the sensor frame."""
        if self.unit_vectors is not None:
            return self.unit_vectors
        assert self.beam_angles is not None
        return np.column_stack((np.cos(self.beam_angles), np.sin(self.beam_angles)))


def observation_from_scan(topic: str, scan: Scan, height: float = 0.0) -> Observation:
    """Convert a laser scan to a costmap observation.

    Args:
        topic: Topic of the scan.
        scan: The scan.
        height: Height of the laser above the floor [m].
    """
    return Observation(
        topic,
        scan.stamp,
        scan.laser_in_base,
        scan.angles,
        scan.ranges,
        scan.range_min,
        scan.range_max,
        height,
        height,
    )


def observation_from_points(
    topic: str,
    stamp: float,
    sensor_in_base: Pose2,
    points_xyz: np.ndarray,
    sensor_height: float = 0.0,
    frame_in_base: np.ndarray = np.eye(4),
) -> Observation:
    """Convert a point cloud to a costmap observation.

    Args:
        topic: Topic of the cloud.
        stamp: Time of the measurement [s].
        sensor_in_base: Sensor in the base frame.
        points_xyz: (N, 3) points [m]; points that are not finite are dropped.
        sensor_height: Height of the sensor above the floor [m].
        frame_in_base: Pose in the base frame, z above the floor, of the frame of the points (4, 4).
    """
    base_in_sensor = sensor_in_base.inverse()
    placement = base_in_sensor.x, base_in_sensor.y, base_in_sensor.yaw
    points_xyz = np.ascontiguousarray(points_xyz, dtype=np.float64)
    frame = np.ascontiguousarray(frame_in_base, dtype=np.float64)
    directions_xy, ranges, heights = _rays(points_xyz, frame, placement)
    return Observation(
        topic,
        stamp,
        sensor_in_base,
        None,
        ranges,
        heights=heights,
        sensor_height=sensor_height,
        unit_vectors=directions_xy,
    )


@numba.njit(cache=True)
def _rays(points_xyz, frame, placement):
    """Directions, lengths and end heights of the rays to the finite points, in the plane of the sensor.

    ``frame``: pose of the points' frame in the base frame; ``placement``: that of the base at the sensor.
    """
    x, y, yaw = placement
    c, s = math.cos(yaw), math.sin(yaw)
    directions = np.empty((points_xyz.shape[0], 2))
    ranges, heights = np.empty(points_xyz.shape[0]), np.empty(points_xyz.shape[0])
    count = 0
    for i in range(points_xyz.shape[0]):
        px, py, pz = points_xyz[i, 0], points_xyz[i, 1], points_xyz[i, 2]
        in_base_x = frame[0, 0] * px + frame[0, 1] * py + frame[0, 2] * pz + frame[0, 3]
        in_base_y = frame[1, 0] * px + frame[1, 1] * py + frame[1, 2] * pz + frame[1, 3]
        height = frame[2, 0] * px + frame[2, 1] * py + frame[2, 2] * pz + frame[2, 3]
        dx = x + c * in_base_x - s * in_base_y
        dy = y + s * in_base_x + c * in_base_y
        length = math.sqrt(dx * dx + dy * dy)
        if not (math.isfinite(length) and math.isfinite(height)):
            continue
        ranges[count], heights[count] = length, height
        directions[count, 0] = dx / length if length > 0.0 else 1.0
        directions[count, 1] = dy / length if length > 0.0 else 0.0
        count += 1
    return directions[:count], ranges[:count], heights[:count]


def observation_from_projected_scan(
    topic: str, scan: Scan, laser_in_base: np.ndarray, origin_xyz: np.ndarray
) -> Observation:
    """Convert the scan of a laser that is tilted, or whose beams begin elsewhere, to a costmap observation.

    The end points are projected onto the floor and keep their heights (laser_geometry).

    Args:
        topic: Topic of the scan.
        scan: The scan; its mounting pose is ignored.
        laser_in_base: Pose of the laser in the base frame, z above the floor (4, 4).
        origin_xyz: (3,) origin of the beams in the base frame, z above the floor [m].

    Returns:
        One beam for each of the scan, from the origin; NaN ranges where the scan has no valid range.
    """
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    reach = np.where(scan.hits, scan.ranges.astype(np.float64), scan.range_max)
    ends_in_laser = np.column_stack((reach * np.cos(angles), reach * np.sin(angles), np.zeros(len(reach))))
    ends = ends_in_laser @ laser_in_base[:3, :3].T + laser_in_base[:3, 3]
    origin_xy = origin_xyz[:2]
    offsets_xy = ends[:, :2] - origin_xy
    ranges = np.where(scan.hits, np.hypot(offsets_xy[:, 0], offsets_xy[:, 1]), np.nan)
    ranges[np.isposinf(scan.ranges)] = np.inf
    offset = float(np.hypot(*(laser_in_base[:2, 3] - origin_xy)))
    return Observation(
        topic,
        scan.stamp,
        Pose2(float(origin_xy[0]), float(origin_xy[1])),
        np.arctan2(offsets_xy[:, 1], offsets_xy[:, 0]),
        ranges,
        0.0,
        scan.range_max + offset,
        ends[:, 2],
        float(origin_xyz[2]),
    )
