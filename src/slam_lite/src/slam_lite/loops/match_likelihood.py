"""Likelihood of a match of two segments, judged by how well each of them agrees with itself.

Hedges, fences, glass and people contradict each other at the right place as well: a share of their points
is seen through or not matched. The scans of one segment alone show how large it is, every other one compared
with those between. A fixed bound would reject all matches outdoors, or accept too many indoors.
"""

import math
from typing import Sequence

import numpy as np

from planar import Pose2
from slam_lite.loops.visibility import PosedCloud, merged_walls, seen_through_fraction, visibility_conflict
from slam_lite.matching.local_map import LocalMap
from slam_lite.matching.refinement import refine
from slam_lite.point_cloud import downsampled, merge_clouds

# Mean and standard deviation, for right and for wrong matches, of the logarithm of the visibility conflict as
# a multiple of the own one, and of the response as a share of the own one. Measured on a campus and on
# generated sites, between places that are known to be the same or to differ.
_CONFLICT_RIGHT, _CONFLICT_WRONG = (0.0, 0.6), (1.3, 0.9)
_RESPONSE_RIGHT, _RESPONSE_WRONG = (1.0, 0.1), (0.7, 0.17)
# Conflict at the same place of segments that agree with themselves: of an object that moved, or of an edge.
_LEAST_CONFLICT = 0.0125
_MAX_POINTS = 500
_FIXED = 1e9 * np.eye(3)


def log_likelihood_ratio(
    place: Sequence[PosedCloud],
    recent: Sequence[PosedCloud],
    recent_in_place: Pose2,
    response: float,
    local_map: LocalMap,
) -> float:
    """Compute the log of how much more likely a match is if both segments see the same place.

    Args:
        place: Scans of one segment, with their poses in its frame.
        recent: Scans of the other segment, with their poses in its frame.
        recent_in_place: Matched pose of the second frame in the first one.
        response: Fraction of the recent points that matches the place, 0 to 1.
        local_map: Working memory; overwritten.

    Returns:
        Natural logarithm of the likelihood ratio; above 0 the same place is more likely than another one.
    """
    conflict = visibility_conflict(place, recent, recent_in_place) / (
        max(_own_conflict(place), _own_conflict(recent)) + _LEAST_CONFLICT
    )
    share = min(1.0, response / max(_own_response(recent, local_map), 1e-3))
    excess = max(0.0, math.log(max(conflict, 1e-9)))
    return (
        _log_density(excess, *_CONFLICT_RIGHT)
        - _log_density(excess, *_CONFLICT_WRONG)
        + _log_density(share, *_RESPONSE_RIGHT)
        - _log_density(share, *_RESPONSE_WRONG)
    )


def _own_conflict(scans: Sequence[PosedCloud]) -> float:
    """Fraction of the points of every other scan of a segment that the scans between them see through."""
    return seen_through_fraction(merged_walls(scans[::2]), scans[1::4])


def _own_response(scans: Sequence[PosedCloud], local_map: LocalMap) -> float:
    """Fraction of the points of every other scan of a segment that match those of the scans between them."""
    if len(scans) < 2:
        return 1.0
    local_map.clear(Pose2())
    for cloud, pose in scans[::2]:
        local_map.add(cloud, pose)
    others = downsampled(merge_clouds(scans[1::2]), _MAX_POINTS)
    return refine(others, local_map, Pose2(), Pose2(), _FIXED).response


def _log_density(value: float, mean: float, sigma: float) -> float:
    """Logarithm of a normal density, without the constant."""
    return -0.5 * ((value - mean) / sigma) ** 2 - math.log(sigma)
