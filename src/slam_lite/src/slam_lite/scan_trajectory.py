"""The trajectory of a log: the pose of every scan, including those that the mapper dropped."""

from array import array
from typing import Optional

import numpy as np

from planar import Pose2, Scan
from slam_lite.mapper import MapUpdate

_COLUMNS = 8


class ScanTrajectory:
    """Poses of scans relative to keyframes, whose poses are final only after the last scan."""

    def __init__(self) -> None:
        # Stamp, keyframe, base in keyframe and laser in base of each scan; a flat array of numbers takes a
        # tenth of the memory of objects.
        self._rows = array("d")
        self._keyframe, self._odom_in_keyframe = 0, Pose2()

    def __len__(self) -> int:
        return len(self._rows) // _COLUMNS

    def add(self, base_in_odom: Pose2, scan: Scan, update: Optional[MapUpdate]) -> None:
        """Add a scan.

        Args:
            base_in_odom: Odometry pose of the base at the scan.
            scan: The scan.
            update: Result of the mapper for the scan; None if it was dropped: then odometry extends the last
                pose.
        """
        if update is not None:
            self._odom_in_keyframe = update.base_in_keyframe @ base_in_odom.inverse()
            self._keyframe = update.keyframe
        base, laser = self._odom_in_keyframe @ base_in_odom, scan.laser_in_base
        self._rows.extend((scan.stamp, self._keyframe, base.x, base.y, base.yaw, laser.x, laser.y, laser.yaw))

    def poses(self, keyframe_poses: np.ndarray, of_laser: bool = False) -> np.ndarray:
        """Return the trajectory in the map frame.

        Args:
            keyframe_poses: (K, 3), final poses of all keyframes in the map frame.
            of_laser: Whether to return the poses of the laser instead of the base.

        Returns:
            (N, 4), rows ``[t, x, y, yaw]`` [s, m, m, rad].
        """
        rows = np.empty((len(self), 4))
        for row, visit in zip(rows, np.array(self._rows).reshape(-1, _COLUMNS)):
            pose = Pose2.from_array(keyframe_poses[int(visit[1])]) @ Pose2.from_array(visit[2:5])
            if of_laser:
                pose = pose @ Pose2.from_array(visit[5:])
            row[:] = visit[0], pose.x, pose.y, pose.yaw
        return rows
