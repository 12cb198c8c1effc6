"""Which way a scan has looked, and so what another scan can know of."""

import math

import numba
import numpy as np

from planar import Pose2
from slam_lite.surface import Surface

_SECTORS = 72


class View:
    """The directions in which the scan ``surface``, taken from ``base_in_track``, has seen something."""

    def __init__(self, surface: Surface, base_in_track: Pose2):
        self._base_in_track = base_in_track
        self._sectors = np.zeros(_SECTORS, dtype=np.bool_)
        seen = _sectors_of(surface.points_xy, 0.0, 0.0, 0.0)
        for beside in (-1, 0, 1):
            self._sectors[(seen + beside) % _SECTORS] = True

    def new_share(self, surface: Surface, base_in_track: Pose2) -> float:
        """Share of another scan's points, 0 to 1, that lie in other directions."""
        if len(surface) == 0:
            return 0.0
        moved = self._base_in_track.inverse() @ base_in_track
        sectors = _sectors_of(surface.points_xy, moved.x, moved.y, moved.yaw)
        return 1.0 - float(np.mean(self._sectors[sectors]))


@numba.njit(cache=True, nogil=True)
def _sectors_of(points, x, y, yaw):
    """The sector (N,) of the circle around the origin in which each point lies, seen from a pose."""
    sectors = np.empty(len(points), dtype=np.int64)
    c, s = math.cos(yaw), math.sin(yaw)
    for p in range(len(points)):
        px = x + c * points[p, 0] - s * points[p, 1]
        py = y + s * points[p, 0] + c * points[p, 1]
        turn = (math.atan2(py, px) / (2.0 * math.pi)) % 1.0
        sectors[p] = int(turn * _SECTORS) % _SECTORS
    return sectors
