"""Removal of moving points from the scans of a segment.

Outdoors, pedestrians may cause half of the points of a scan, which match nothing seen before.
"""

from typing import Sequence

import numba
import numpy as np

from slam_lite.loops.visibility import PosedCloud
from slam_lite.point_cloud import PointCloud, merge_clouds

# Scans with fewer points than this on average are filtered.
_SPARSE = 60
# A point is static if a scan at least _SCANS_APART scans away has a point within about one cell [m].
_CELL, _SCANS_APART = 0.3, 5


def static_points(scans: Sequence[PosedCloud]) -> PointCloud:
    """Merge the static points of scans.

    Dense scans are merged without a check: few of their points are on moving objects.

    Args:
        scans: Points of each scan with its pose in a common frame.

    Returns:
        Points in the common frame.
    """
    merged = merge_clouds(scans)
    if len(merged) == 0 or len(scans) <= _SCANS_APART or len(merged) > _SPARSE * len(scans):
        return merged
    number = np.repeat(np.arange(len(scans)), [len(cloud) for cloud, _ in scans])
    cells = np.floor(merged.points_xy / _CELL).astype(np.int64)
    cells -= cells.min(axis=0) - 1
    width = int(cells[:, 0].max()) + 2
    is_static = _is_static(cells[:, 0] + width * cells[:, 1], width, number)
    return PointCloud(merged.points_xy[is_static], merged.normals_xy[is_static])


@numba.njit(cache=True, nogil=True)
def _is_static(cells, width, number):
    """Whether scans far enough apart have a point in the cell of each point or beside it, (N,)."""
    first, last = {cells[0]: number[0]}, {cells[0]: number[0]}
    for i in range(len(cells)):
        if cells[i] not in first:
            first[cells[i]] = number[i]
        last[cells[i]] = number[i]
    is_static = np.zeros(len(cells), dtype=np.bool_)
    for i in range(len(cells)):
        for row in range(-1, 2):
            for col in range(-1, 2):
                neighbour = cells[i] + row * width + col
                if neighbour in first:
                    apart = max(number[i] - first[neighbour], last[neighbour] - number[i])
                    is_static[i] = is_static[i] or apart >= _SCANS_APART
    return is_static
