"""Search for a loop closure at a candidate: a good match, and the only good one in the window."""

import math
from typing import List, Optional, Sequence

import numpy as np

from planar import Pose2
from slam_lite.config import MapperSettings
from slam_lite.graph.pose_graph import Edge, relative_pose
from slam_lite.loops.degeneracy import PoseConstraint, constraint_at_peak, refine_at
from slam_lite.loops.loop_candidates import LoopCandidate
from slam_lite.loops.loop_closure import CERTAIN_RATIO, LoopClosure
from slam_lite.loops.match_likelihood import log_likelihood_ratio
from slam_lite.loops.static_points import static_points
from slam_lite.loops.visibility import PosedCloud, seen_fraction
from slam_lite.matching.correlative import search_branch_and_bound
from slam_lite.matching.local_map import LocalMap
from slam_lite.point_cloud import PointCloud, downsampled

# Keyframes of the place, to each side, and their distance from it [m], that are merged for a match in a small
# window.
_PLACE_KEYFRAMES, _PLACE_RADIUS = 20, 6.0
# Least log likelihood ratio of a match, and least share of its points that the place has in view: a robot
# that arrives from elsewhere has seen much that the place cannot show.
_MIN_RATIO, _MIN_SEEN = 1.0, 0.6
_MIN_POINTS, _MAX_POINTS = 50, 500


def find_loop_closure(
    candidate: LoopCandidate,
    poses: np.ndarray,
    clouds: Sequence[PointCloud],
    local_map: LocalMap,
    settings: MapperSettings,
) -> Optional[LoopClosure]:
    """Match the recent keyframes of a candidate to those around its place.

    Args:
        candidate: Candidate to search.
        poses: (N, 3), poses of all keyframes in the map frame.
        clouds: Points of all keyframes, each in its base frame.
        local_map: Working memory; overwritten.
        settings: ``closure_min_response``.

    Returns:
        The loop closure, which still has to be verified; None if there is no good and unambiguous match.
    """
    place, recent = candidate.place, candidate.recent
    first_recent = recent - candidate.recent_keyframes + 1
    place_clouds = _clouds_around(place, candidate.scale, first_recent, poses, clouds)
    recent_clouds = [(clouds[i], relative_pose(poses, recent, i)) for i in range(first_recent, recent + 1)]
    recent_cloud = downsampled(static_points(recent_clouds), _MAX_POINTS)
    if len(recent_cloud) < _MIN_POINTS:
        return None
    local_map.clear(Pose2())
    layer = local_map.layer_for(recent_cloud)
    for cloud, pose in place_clouds:
        local_map.add(cloud, pose, layer is not local_map)
    min_score, sample = 0.7 * settings.closure_min_response, downsampled(recent_cloud, 200)
    peak = search_branch_and_bound(sample, layer, candidate.guess, candidate.window, min_score, apart=0.6)
    if peak is None or not peak.is_unique or (candidate.is_recognized and peak.degenerate_direction.any()):
        return None
    min_response = settings.closure_min_response * (1.0 if candidate.is_ambiguous else _MIN_SEEN)
    constraint = constraint_at_peak(
        peak,
        candidate.guess,
        recent_cloud,
        local_map,
        lambda start: refine_at(start, recent_cloud, local_map, min_response),
    )
    if constraint is None:
        return None
    ratio: Optional[float] = 0.0
    if candidate.is_ambiguous or constraint.response < settings.closure_min_response:
        seen = _seen_fraction(recent_cloud, constraint.base_in_place, place_clouds)
        ratio = _ratio_if_likely(constraint, seen, place_clouds, recent_clouds, local_map, settings)
    if ratio is None:
        return None
    edge = Edge(place, recent, constraint.base_in_place, constraint.information, is_loop=True)
    return LoopClosure(edge, candidate, constraint.degenerate_direction, ratio)


def _ratio_if_likely(
    constraint: PoseConstraint,
    seen: float,
    place: Sequence[PosedCloud],
    recent: Sequence[PosedCloud],
    local_map: LocalMap,
    settings: MapperSettings,
) -> Optional[float]:
    """Log likelihood ratio of a match, if large enough; ``seen``: fraction that the place has in view."""
    response, least = constraint.response, _MIN_RATIO
    if response < settings.closure_min_response:
        response, least = response / max(seen, _MIN_SEEN), CERTAIN_RATIO
    if response < settings.closure_min_response:
        return None
    ratio = log_likelihood_ratio(place, recent, constraint.base_in_place, response, local_map)
    return ratio if ratio >= least else None


def _seen_fraction(cloud: PointCloud, base_in_place: Pose2, place: Sequence[PosedCloud]) -> float:
    """Fraction, 0 to 1, of the points of a cloud that the scans of a place have in view."""
    return seen_fraction(base_in_place.transform_points(cloud.points_xy), place)


def _clouds_around(
    place: int, scale: float, end: int, poses: np.ndarray, clouds: Sequence[PointCloud]
) -> List[PosedCloud]:
    """Return the keyframes near a place, before keyframe ``end``, with their poses in the place's frame."""
    reach = round(scale * _PLACE_KEYFRAMES)
    keyframes = range(max(0, place - reach), min(end, place + reach + 1))
    posed = [(clouds[i], relative_pose(poses, place, i)) for i in keyframes]
    return [(cloud, pose) for cloud, pose in posed if math.hypot(pose.x, pose.y) < scale * _PLACE_RADIUS]
