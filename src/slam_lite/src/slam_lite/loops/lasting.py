"""What stays where it is, of all that is seen on a stretch of the way.

In a yard, people who walk by may be half of what there is to see, and fit nothing that was seen before.
"""

from typing import Sequence

import numba
import numpy as np

from slam_lite.loops.sight import Placed
from slam_lite.surface import Surface, joined

# Where scans have fewer points than this, people matter.
_SPARSE = 60
# A point lasts if another scan, so many scans on or back, saw one within a cell or so of this size, metres.
_CELL, _SCANS_APART = 0.3, 5


def lasting(scans: Sequence[Placed]) -> Surface:
    """The points of scans on the way, each with its pose, that last; all of them where there are many."""
    everything = joined(scans)
    if len(everything) == 0 or len(scans) <= _SCANS_APART or len(everything) > _SPARSE * len(scans):
        return everything
    number = np.repeat(np.arange(len(scans)), [len(surface) for surface, _ in scans])
    cells = np.floor(everything.points_xy / _CELL).astype(np.int64)
    cells -= cells.min(axis=0) - 1
    width = int(cells[:, 0].max()) + 2
    lasts = _lasts(cells[:, 0] + width * cells[:, 1], width, number)
    return Surface(everything.points_xy[lasts], everything.normals_xy[lasts])


@numba.njit(cache=True, nogil=True)
def _lasts(cells, width, number):
    """Whether scans far enough apart saw something in the cell of each point or beside it, (N,)."""
    first, last = {cells[0]: number[0]}, {cells[0]: number[0]}
    for i in range(len(cells)):
        if cells[i] not in first:
            first[cells[i]] = number[i]
        last[cells[i]] = number[i]
    lasts = np.zeros(len(cells), dtype=np.bool_)
    for i in range(len(cells)):
        for row in range(-1, 2):
            for col in range(-1, 2):
                beside = cells[i] + row * width + col
                if beside in first:
                    apart = max(number[i] - first[beside], last[beside] - number[i])
                    lasts[i] = lasts[i] or apart >= _SCANS_APART
    return lasts
