"""Degenerate matches: along a smooth corridor a scan matches anywhere.

There a match measures the position across the corridor and the heading, but not the position along it. So the
degenerate direction has to be exact, or else the unknown position along the corridor turns into an error
across it; and of all the poses that match, the one nearest to the guess is taken, as there such an error is
least.
"""

import math
from dataclasses import dataclass
from typing import Callable, Optional

import numpy as np

from planar import Pose2
from slam_lite.matching.correlative import Peak, score_poses
from slam_lite.matching.local_map import LocalMap, Match
from slam_lite.matching.refinement import refine
from slam_lite.point_cloud import PointCloud

# Distances [m] by which a match is shifted, and the share of its score that it must keep to count as
# matching.
_SHIFTS = np.concatenate((-np.arange(0.2, 1.05, 0.1), np.arange(0.2, 1.05, 0.1)))
_MIN_SCORE_SHARE = 0.9
# Shift from which on a match is degenerate [m].
_DEGENERATE_SHIFT = 0.95
# Standard deviation along a degenerate direction [m].
_UNKNOWN_SIGMA = 1e3
# Cosine of the angle up to which two degenerate directions are along the same corridor.
PARALLEL = 0.95
# How far a match may be from the cell that led to it, metres and radians.
_MAX_MOVED, _MAX_TURNED = 0.3, 0.1


@dataclass(frozen=True, eq=False)
class PoseConstraint:
    """Relative pose that a match measures.

    Attributes:
        base_in_place: Pose of the base in the frame of the place.
        information: (3, 3), of that pose, 1 / (m, m, rad)^2.
        degenerate_direction: Unit vector (2,) along which there is no information; zeros if there is none.
        response: Fraction of the points that match, 0 to 1.
    """

    base_in_place: Pose2
    information: np.ndarray
    degenerate_direction: np.ndarray
    response: float


def refine_at(start: Pose2, cloud: PointCloud, local_map: LocalMap, min_response: float) -> Optional[Match]:
    """Refine a match without prior.

    Args:
        start: Initial pose of the base in the frame of the local map.
        cloud: Points to match, in the base frame.
        local_map: Map to match to.
        min_response: Least fraction of matching points, 0 to 1.

    Returns:
        The match; None if it is more than 0.3 m or 0.1 rad from ``start`` or its response is too low.
    """
    match = refine(cloud, local_map, start, start, np.zeros((3, 3)))
    moved = start.inverse() @ match.base_pose
    is_near = math.hypot(moved.x, moved.y) <= _MAX_MOVED and abs(moved.yaw) <= _MAX_TURNED
    return match if is_near and match.response >= min_response else None


def constraint_at_peak(
    peak: Peak,
    guess: Pose2,
    cloud: PointCloud,
    local_map: LocalMap,
    match_at: Callable[[Pose2], Optional[Match]],
) -> Optional[PoseConstraint]:
    """Measure the pose of the base at a peak of the search.

    Args:
        peak: Best pose of the search.
        guess: Estimated pose of the base in the frame of the local map; along a degenerate direction the
            match nearest to it is used.
        cloud: Points that were searched, in the base frame.
        local_map: Map in which they were searched.
        match_at: Refines a match at a pose; returns None if it is not good enough.

    Returns:
        The constraint; None if there is no good match or an equally good one elsewhere.
    """
    match = match_at(peak.base_pose)
    if match is None:
        return None
    _, directions = np.linalg.eigh(match.information[:2, :2])
    weakest = directions[:, 0]
    if peak.degenerate_direction.any() and abs(peak.degenerate_direction @ weakest) < PARALLEL:
        return None
    is_degenerate = peak.degenerate_direction.any()
    shift = math.inf if is_degenerate else _max_shift(match, weakest, cloud, local_map)
    if shift < _DEGENERATE_SHIFT:
        information = _with_error(match.information, shift * weakest)
        return PoseConstraint(match.base_pose, information, np.zeros(2), match.response)
    match = match_at(_nearest_on_line(match.base_pose, weakest, guess)) or match
    information = _with_error(match.information, _UNKNOWN_SIGMA * weakest)
    return PoseConstraint(match.base_pose, information, weakest, match.response)


def _max_shift(match: Match, direction: np.ndarray, cloud: PointCloud, local_map: LocalMap) -> float:
    """Find how far a match can be shifted along a direction and still match [m].

    The result is at most the largest of ``_SHIFTS``. Along a smooth wall, a few noisy points can fix a match
    although they are not features. The same holds for the corners of a wall of which one side was seen before
    and the other is seen now.
    """
    pose = match.base_pose
    shifted = [Pose2(pose.x + by * direction[0], pose.y + by * direction[1], pose.yaw) for by in _SHIFTS]
    scores = score_poses(cloud, local_map, [pose, *shifted], match_sides=True)
    return float(np.abs(_SHIFTS[scores[1:] >= _MIN_SCORE_SHARE * scores[0]]).max(initial=0.0))


def _nearest_on_line(pose: Pose2, direction: np.ndarray, guess: Pose2) -> Pose2:
    """The pose, shifted along a direction to where it is nearest to the guess."""
    shift = direction @ [guess.x - pose.x, guess.y - pose.y]
    return Pose2(pose.x + shift * direction[0], pose.y + shift * direction[1], pose.yaw)


def _with_error(information: np.ndarray, sigma_xy: np.ndarray) -> np.ndarray:
    """Add a further error of standard deviation ``sigma_xy`` (2,) [m] to an information (3, 3)."""
    sigma = np.append(sigma_xy, 0.0)
    weighted = information @ sigma
    return information - np.outer(weighted, weighted) / (1.0 + sigma @ weighted)
