"""Visibility check: scans must not pass through walls that other scans measured."""

import math
from typing import Iterable, Sequence, Tuple

import numba
import numpy as np

from planar import Pose2
from slam_lite.point_cloud import PointCloud, downsampled, merge_clouds

# The points of a scan, with its pose.
PosedCloud = Tuple[PointCloud, Pose2]

# Sectors of the circle by which beams are compared.
_SECTORS = 360
# Distances [m] by which the beams beside a point must end behind it for the point to count as seen through,
# and within which they must end for it to count as hit.
_BEHIND, _AT = 0.4, 0.2
# Number of points of a segment that are checked, and step between the scans of the other that check them.
_MAX_POINTS, _SCAN_STEP = 500, 4
# Number of scans that decide which points are in view.
_MAX_SCANS = 30


def seen_through_fraction(walls: PointCloud, scans: Iterable[PosedCloud]) -> float:
    """Compute which fraction of wall points scans see through.

    Args:
        walls: Points of the walls.
        scans: Points of each scan, with the pose of its base in the frame of ``walls``.

    Returns:
        Fraction, 0 to 1, of the points that are visible from the scans.
    """
    through, hit = 0, 0
    for scan, base_pose in scans:
        inverse = base_pose.inverse()
        counts = _count_visible(inverse.transform_points(walls.points_xy), scan.points_xy)
        through, hit = through + counts[0], hit + counts[1]
    return through / max(through + hit, 1)


def merged_walls(scans: Sequence[PosedCloud]) -> PointCloud:
    """Return the points of scans that are checked, in their common frame.

    Args:
        scans: Points of each scan, with the pose of its base in a common frame.
    """
    return downsampled(merge_clouds(scans), _MAX_POINTS)


def visibility_conflict(
    place: Sequence[PosedCloud], recent: Sequence[PosedCloud], recent_in_place: Pose2
) -> float:
    """Compute how much two segments contradict each other by what is visible.

    Args:
        place: Scans of one segment, with their poses in its frame.
        recent: Scans of the other segment, with their poses in its frame.
        recent_in_place: Frame of the second segment in that of the first.

    Returns:
        Fraction, 0 to 1, of the walls of one segment that scans of the other see through; the larger of both.
    """
    recent = [(cloud, recent_in_place @ pose) for cloud, pose in recent]
    return max(
        seen_through_fraction(merged_walls(walls), scans[::_SCAN_STEP])
        for walls, scans in ((place, recent), (recent, place))
    )


def seen_fraction(points_xy: np.ndarray, scans: Sequence[PosedCloud]) -> float:
    """Compute which fraction of points at least one of several scans sees, or would see.

    Args:
        points_xy: (N, 2) [m].
        scans: Points of each scan, with the pose of its base in the frame of ``points_xy``.

    Returns:
        Fraction, 0 to 1; the other points are hidden from all scans, or out of their range.
    """
    is_seen = np.zeros(len(points_xy), dtype=np.bool_)
    for cloud, base_pose in scans[:: max(1, len(scans) // _MAX_SCANS)]:
        _classify(base_pose.inverse().transform_points(points_xy), cloud.points_xy, is_seen)
    return float(is_seen.mean()) if len(is_seen) else 0.0


@numba.njit(cache=True, nogil=True)
def _count_visible(points, ends):
    """How many points beams from the origin to ``ends`` see through, and how many they hit."""
    return _classify(points, ends, np.zeros(len(points), dtype=np.bool_))


@numba.njit(cache=True, nogil=True)
def _classify(points, ends, is_seen):
    """Count as ``_count_visible``, and mark the points (N,) that beams see through or hit."""
    nearest, farthest = np.full(_SECTORS, np.inf), np.zeros(_SECTORS)
    for i in range(len(ends)):
        sector, distance = _polar(ends[i])
        nearest[sector] = min(nearest[sector], distance)
        farthest[sector] = max(farthest[sector], distance)
    through, hit = 0, 0
    for i in range(len(points)):
        sector, distance = _polar(points[i])
        least, most, is_visible = np.inf, 0.0, True
        for neighbour in (-1, 0, 1):
            at = (sector + neighbour) % _SECTORS
            is_visible = is_visible and farthest[at] > 0.0
            least, most = min(least, nearest[at]), max(most, farthest[at])
        if not is_visible:
            continue
        if least > distance + _BEHIND:
            through += 1
            is_seen[i] = True
        elif least < distance + _AT and most > distance - _AT:
            hit += 1
            is_seen[i] = True
    return through, hit


@numba.njit(cache=True, nogil=True)
def _polar(point):
    """Sector and distance of a point."""
    turn = (math.atan2(point[1], point[0]) / (2.0 * math.pi)) % 1.0
    return int(turn * _SECTORS) % _SECTORS, math.hypot(point[0], point[1])
