"""The directions that a scan has covered, to find how much of another scan is new."""

import math

import numba
import numpy as np

from planar import Pose2
from slam_lite.point_cloud import PointCloud

_SECTORS = 72


class AngularCoverage:
    """The sectors around a scan's base in which it has returns."""

    def __init__(self, cloud: PointCloud, base_in_track: Pose2):
        """Record the sectors that a scan covers.

        Args:
            cloud: Points of the scan, in the base frame.
            base_in_track: Pose of the base at the scan, in the track frame.
        """
        self._base_in_track = base_in_track
        self._sectors = np.zeros(_SECTORS, dtype=np.bool_)
        covered = _sectors_of(cloud.points_xy, 0.0, 0.0, 0.0)
        for neighbour in (-1, 0, 1):
            self._sectors[(covered + neighbour) % _SECTORS] = True

    def unseen_fraction(self, cloud: PointCloud, base_in_track: Pose2) -> float:
        """Compute which fraction of another scan lies in sectors that this scan does not cover.

        Args:
            cloud: Points of the other scan, in its base frame.
            base_in_track: Pose of the base at the other scan, in the track frame.

        Returns:
            Fraction of the points, 0 to 1; 0 for a scan without points.
        """
        if len(cloud) == 0:
            return 0.0
        moved = self._base_in_track.inverse() @ base_in_track
        sectors = _sectors_of(cloud.points_xy, moved.x, moved.y, moved.yaw)
        return 1.0 - float(np.mean(self._sectors[sectors]))


@numba.njit(cache=True, nogil=True)
def _sectors_of(points, x, y, yaw):
    """Sector (N,) of the circle around the origin that each point lies in, seen from a pose."""
    sectors = np.empty(len(points), dtype=np.int64)
    c, s = math.cos(yaw), math.sin(yaw)
    for p in range(len(points)):
        px = x + c * points[p, 0] - s * points[p, 1]
        py = y + s * points[p, 0] + c * points[p, 1]
        turn = (math.atan2(py, px) / (2.0 * math.pi)) % 1.0
        sectors[p] = int(turn * _SECTORS) % _SECTORS
    return sectors
