"""What a sensor saw, in the one form that costmaps take in."""

from dataclasses import dataclass
from typing import Union

import numpy as np

from planar import Pose2, Scan


@dataclass(frozen=True, eq=False)
class Observation:
    """Beams from a sensor: of a laser scan, or to the points of a cloud.

    ``topic``: where it came from. ``sensor_in_base``: pose of the beams' origin in the base frame.
    ``angles``, ``ranges``: (N,); a beam ends at something if its range lies in [range_min, range_max).
    ``heights``: of what the beams end at, above the floor: metres, one for all or (N,).
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
    """A laser scan, ``height`` metres above the floor."""
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
    """A cloud of points (N, 3) in the base frame, z above the floor; those not finite are left out."""
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
