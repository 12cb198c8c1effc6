"""Trajectories: a pose for every scan, also of those that the mapper left out."""

from array import array
from typing import Optional

import numpy as np

from planar import Pose2, Scan
from slam_lite.mapper import MapUpdate

_COLUMNS = 8


class Trajectory:
    """Collects where scans were taken relative to the key scans, whose poses are known only in the end."""

    def __init__(self) -> None:
        # Stamp and key, base in key, laser in base of each scan: as numbers they take a tenth of the memory.
        self._visits = array("d")
        self._key, self._odom_in_key = 0, Pose2()

    def __len__(self) -> int:
        return len(self._visits) // _COLUMNS

    def add(self, base_in_odom: Pose2, scan: Scan, update: Optional[MapUpdate]) -> None:
        """Adds a scan and what the mapper made of it; without an update odometry moves the last pose on."""
        if update is not None:
            self._odom_in_key = update.base_in_key @ base_in_odom.inverse()
            self._key = update.key
        base, laser = self._odom_in_key @ base_in_odom, scan.laser_in_base
        self._visits.extend((scan.stamp, self._key, base.x, base.y, base.yaw, laser.x, laser.y, laser.yaw))

    def poses(self, key_poses: np.ndarray, of_laser: bool = False) -> np.ndarray:
        """Stamps and poses (N, 4) ``[t, x, y, yaw]`` in the map, of the base or of the laser."""
        rows = np.empty((len(self), 4))
        for row, visit in zip(rows, np.array(self._visits).reshape(-1, _COLUMNS)):
            pose = Pose2.from_array(key_poses[int(visit[1])]) @ Pose2.from_array(visit[2:5])
            if of_laser:
                pose = pose @ Pose2.from_array(visit[5:])
            row[:] = visit[0], pose.x, pose.y, pose.yaw
        return rows
