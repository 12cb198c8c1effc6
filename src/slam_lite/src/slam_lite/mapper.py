"""The mapper: scans and odometry in, poses and a map out."""

import math
from dataclasses import dataclass
from typing import List, Optional

import numpy as np

from planar import OccupancyGrid, Pose2, Scan
from slam_lite.back_end import BackEnd, ClosureResult, ClosureTask
from slam_lite.config import MapperSettings
from slam_lite.front_end import FrontEnd, Tracked
from slam_lite.rendering import Beams, MapRenderer, beams_of
from slam_lite.surface import Surface, surface_of

# Odometry of less than this, metres or radians, counts as standing still.
_STILL = 1e-3


@dataclass(frozen=True, eq=False)
class MapUpdate:
    """Where a scan was taken.

    ``key``, ``base_in_key``: the pose relative to a key scan, which stays true when the key is moved later.
    ``response``: share of the scan explained by the recent scans; ``surprise``: squared deviation of the
    matched from the odometric motion in units of its variance, 3 on average for good odometry.
    """

    base_in_map: Pose2
    odom_in_map: Pose2
    key: int
    base_in_key: Pose2
    is_key: bool
    response: float
    surprise: float


class Mapper:
    """Graph SLAM with a planar laser.

    A front end follows the robot against its recent scans; key scans become nodes of a pose graph, in which a
    back end closes loops; the map is drawn from all key scans at their present poses. The map frame is the
    odometry frame as it was at the first scan. Without ``deferred``, loops are closed inside ``insert``; with
    it, somebody has to run ``task()`` and ``adopt`` its result now and then.
    """

    def __init__(self, settings: MapperSettings = MapperSettings(), deferred: bool = False):
        self._settings = settings
        self._deferred = deferred
        self._front_end = FrontEnd(settings)
        self._back_end = BackEnd(settings)
        self._beams: List[Beams] = []
        self._renderer = MapRenderer(settings.resolution, settings.occupied_threshold)
        self._searched = 0
        self._key_in_track = Pose2()
        self._last_stamp = -math.inf
        self._last_in_odom: Optional[Pose2] = None

    def insert(self, base_in_odom: Pose2, scan: Scan) -> Optional[MapUpdate]:
        """Takes one scan in; None if it says nothing new because the robot stands still."""
        if self._stands_still(base_in_odom, scan.stamp):
            return None
        self._last_in_odom, self._last_stamp = base_in_odom, scan.stamp
        max_range = self._settings.max_range or scan.range_max - 0.01
        usable_range = self._settings.usable_range or max_range
        surface = surface_of(scan, usable_range, self._settings.point_spacing)
        tracked = self._front_end.track(base_in_odom, surface)
        if tracked.is_key:
            self._add_key(tracked, surface, beams_of(scan, max_range, usable_range))
        base_in_key = self._key_in_track.inverse() @ tracked.base_in_track
        key = len(self._back_end) - 1
        base_in_map = self._back_end.pose(key) @ base_in_key
        odom_in_map = base_in_map @ base_in_odom.inverse()
        return MapUpdate(
            base_in_map, odom_in_map, key, base_in_key, tracked.is_key, tracked.response, tracked.surprise
        )

    def task(self) -> Optional[ClosureTask]:
        """The loop closure search that is due, if one is."""
        settings = self._settings
        if not settings.close_loops or len(self._back_end) < self._searched + settings.closure_interval:
            return None
        self._searched = len(self._back_end)
        return self._back_end.task()

    def adopt(self, result: ClosureResult) -> None:
        """Takes over what a task found."""
        self._back_end.adopt(result)

    def settle(self) -> None:
        """Brings the poses of all keys to rest, as after the last scan."""
        self._back_end.settle()

    @property
    def key_poses(self) -> np.ndarray:
        """Poses (N, 3) in the map of all key scans."""
        return self._back_end.poses

    @property
    def loop_count(self) -> int:
        """How many loop closures tie the graph."""
        return int(self._back_end.edges.is_loop.sum())

    def grid(self) -> OccupancyGrid:
        """The map of all key scans at their present poses."""
        self._renderer.update(self._beams, self._back_end.poses)
        return self._renderer.grid()

    def _stands_still(self, base_in_odom: Pose2, stamp: float) -> bool:
        if self._last_in_odom is None or stamp - self._last_stamp >= self._settings.still_interval:
            return False
        motion = self._last_in_odom.inverse() @ base_in_odom
        return math.hypot(motion.x, motion.y) < _STILL and abs(motion.yaw) < _STILL

    def _add_key(self, tracked: Tracked, surface: Surface, beams: Beams) -> None:
        if len(self._back_end) == 0:
            self._back_end.add_first(surface, tracked.base_in_track)
        else:
            base_in_last = self._key_in_track.inverse() @ tracked.base_in_track
            turned = _rotated(tracked.information, -self._key_in_track.yaw)
            self._back_end.add(surface, base_in_last, turned)
        self._key_in_track = tracked.base_in_track
        self._beams.append(beams)
        if not self._deferred:
            task = self.task()
            if task is not None:
                self.adopt(task.run())


def _rotated(information: np.ndarray, angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return turn @ information @ turn.T
