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
    """

    topic: str
    stamp: float
    sensor_in_base: Pose2
    angles: np.ndarray
    ranges: np.ndarray
    range_min: float = 0.0
    range_max: float = np.inf
    heights: Union[float, np.ndarray] = 0.0


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
    )


def observation_from_points(
    topic: str, stamp: float, sensor_in_base: Pose2, points_xyz: np.ndarray
) -> Observation:
    """Convert a point cloud to a costmap observation.

    Args:
        topic: Topic of the cloud.
        stamp: Time of the measurement [s].
        sensor_in_base: Sensor in the base frame.
        points_xyz: (N, 3) points in the base frame, z above the floor [m]; points that are not finite are
            dropped.
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
    )


def observation_from_projected_scan(
    topic: str, scan: Scan, laser_in_base: np.ndarray, origin_xy: np.ndarray
) -> Observation:
    """Convert the scan of a laser that is tilted, or whose beams begin elsewhere, to a costmap observation.

    The end points are projected onto the floor and keep their heights (laser_geometry).

    Args:
        topic: Topic of the scan.
        scan: The scan; its mounting pose is ignored.
        laser_in_base: Pose of the laser in the base frame, z above the floor (4, 4).
        origin_xy: (2,) origin of the beams in the base frame [m].

    Returns:
        One beam for each of the scan, from ``origin_xy``; NaN ranges where the scan has no valid range.
    """
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    reach = np.where(scan.hits, scan.ranges.astype(np.float64), scan.range_max)
    ends_in_laser = np.column_stack((reach * np.cos(angles), reach * np.sin(angles), np.zeros(len(reach))))
    ends = ends_in_laser @ laser_in_base[:3, :3].T + laser_in_base[:3, 3]
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
    )
