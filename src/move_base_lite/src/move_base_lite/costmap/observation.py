"""Costmap observation: a laser scan or point cloud as costmap layers use it (costmap_2d: Observation)."""

from dataclasses import dataclass
from typing import Union

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
        angles: (N,) angles of the beams in the sensor frame [rad].
        ranges: (N,) ranges [m].
        range_min: Shortest valid range [m].
        range_max: Limit of valid ranges [m].
        heights: Heights of the end points above the floor [m], one for all or (N,).
        sensor_height: Height of the origin of the beams above the floor [m].
    """

    topic: str
    stamp: float
    sensor_in_base: Pose2
    angles: np.ndarray
    ranges: np.ndarray
    range_min: float = 0.0
    range_max: float = np.inf
    heights: Union[float, np.ndarray] = 0.0
    sensor_height: float = 0.0


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
    topic: str, stamp: float, sensor_in_base: Pose2, points_xyz: np.ndarray, sensor_height: float = 0.0
) -> Observation:
    """Convert a point cloud to a costmap observation.

    Args:
        topic: Topic of the cloud.
        stamp: Time of the measurement [s].
        sensor_in_base: Sensor in the base frame.
        points_xyz: (N, 3) points in the base frame, z above the floor [m]; points that are not finite are
            dropped.
        sensor_height: Height of the sensor above the floor [m].
    """
    points_xyz = points_xyz[np.isfinite(points_xyz).all(axis=1)]
    offsets_xy = sensor_in_base.inverse().transform_points(points_xyz[:, :2])
    return Observation(
        topic,
        stamp,
        sensor_in_base,
        np.arctan2(offsets_xy[:, 1], offsets_xy[:, 0]),
        np.hypot(offsets_xy[:, 0], offsets_xy[:, 1]),
        heights=points_xyz[:, 2],
        sensor_height=sensor_height,
    )
