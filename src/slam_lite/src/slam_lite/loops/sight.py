"""Whether scans see through what others take for walls."""

import math
from typing import Iterable, Sequence, Tuple

import numba
import numpy as np

from planar import Pose2
from slam_lite.surface import Surface, joined, thinned

Placed = Tuple[Surface, Pose2]

# Beams are told apart by their direction in so many sectors of the circle.
_SECTORS = 360
# A point is seen through if the beams beside it end so much behind it, met if they end so near to it, metres.
_BEHIND, _AT = 0.4, 0.2
# Of two stretches of the way, so many points are looked at, and one of so many scans.
_MAX_POINTS, _EVERY = 500, 4


def share_seen_through(solid: Surface, scans: Iterable[Tuple[Surface, Pose2]]) -> float:
    """Share, 0 to 1, of the points in sight of some scans, each from its pose, that these see through."""
    through, met = 0, 0
    for scan, base_pose in scans:
        inverse = base_pose.inverse()
        counts = _sight(inverse.transform_points(solid.points_xy), scan.points_xy)
        through, met = through + counts[0], met + counts[1]
    return through / max(through + met, 1)


def clash(there: Sequence[Placed], here: Sequence[Placed], recent_in_place: Pose2) -> float:
    """Share of the walls of one stretch that the other one's scans see through, 0 to 1, whichever is more."""
    here = [(surface, recent_in_place @ pose) for surface, pose in here]
    return max(
        share_seen_through(thinned(joined(solid), _MAX_POINTS), scans[::_EVERY])
        for solid, scans in ((there, here), (here, there))
    )


@numba.njit(cache=True, nogil=True)
def _sight(points, ends):
    """How many points are seen through, and how many are seen, by beams from the origin to ``ends``."""
    nearest, farthest = np.full(_SECTORS, np.inf), np.zeros(_SECTORS)
    for i in range(len(ends)):
        sector, distance = _polar(ends[i])
        nearest[sector] = min(nearest[sector], distance)
        farthest[sector] = max(farthest[sector], distance)
    through, met = 0, 0
    for i in range(len(points)):
        sector, distance = _polar(points[i])
        least, most, is_seen = np.inf, 0.0, True
        for beside in (-1, 0, 1):
            at = (sector + beside) % _SECTORS
            is_seen = is_seen and farthest[at] > 0.0
            least, most = min(least, nearest[at]), max(most, farthest[at])
        if not is_seen:
            continue
        if least > distance + _BEHIND:
            through += 1
        elif least < distance + _AT and most > distance - _AT:
            met += 1
    return through, met


@numba.njit(cache=True, nogil=True)
def _polar(point):
    """The sector that a point lies in, and its distance."""
    turn = (math.atan2(point[1], point[0]) / (2.0 * math.pi)) % 1.0
    return int(turn * _SECTORS) % _SECTORS, math.hypot(point[0], point[1])
