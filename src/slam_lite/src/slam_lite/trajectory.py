"""Trajectories: a pose for every scan, also of those that the mapper left out."""

from typing import List, NamedTuple, Optional

import numpy as np

from planar import Pose2, Scan
from slam_lite.mapper import MapUpdate


class _Visit(NamedTuple):
    stamp: float
    key: int
    base_in_key: Pose2
    laser_in_base: Pose2


class Trajectory:
    """Collects where scans were taken relative to the key scans, whose poses are known only in the end."""

    def __init__(self) -> None:
        self._visits: List[_Visit] = []
        self._key, self._odom_in_key = 0, Pose2()

    def __len__(self) -> int:
        return len(self._visits)

    def add(self, base_in_odom: Pose2, scan: Scan, update: Optional[MapUpdate]) -> None:
        """Adds a scan and what the mapper made of it; without an update odometry moves the last pose on."""
        if update is not None:
            self._odom_in_key = update.base_in_key @ base_in_odom.inverse()
            self._key = update.key
        base_in_key = self._odom_in_key @ base_in_odom
        self._visits.append(_Visit(scan.stamp, self._key, base_in_key, scan.laser_in_base))

    def poses(self, key_poses: np.ndarray, of_laser: bool = False) -> np.ndarray:
        """Stamps and poses (N, 4) ``[t, x, y, yaw]`` in the map, of the base or of the laser."""
        rows = np.empty((len(self), 4))
        for row, visit in zip(rows, self._visits):
            pose = Pose2.from_array(key_poses[visit.key]) @ visit.base_in_key
            if of_laser:
                pose = pose @ visit.laser_in_base
            row[:] = visit.stamp, pose.x, pose.y, pose.yaw
        return rows
