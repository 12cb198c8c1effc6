"""Sequence-based place recognition: hypotheses that stay consistent along a long path, after the last scan.

One query returns many places, including places at different sides of the same building. Only correct ones
stay consistent over some sixty metres of queries. They are initial guesses for matching segments (see
``revisited_segments``).
"""

import math
from typing import List, Sequence

import numba
import numpy as np

from planar import Pose2, wrap
from slam_lite.graph.node_covariance import NodeCovariance
from slam_lite.graph.pose_graph import Edge, Edges, relative_pose
from slam_lite.loops.place_recognition import (
    PlaceHypothesis,
    compose_poses,
    descriptors_along,
    match_places,
)
from slam_lite.loops.tracked_trajectory import TrackedTrajectory
from slam_lite.point_cloud import PointCloud

# Path [m] after which a place counts as revisited, and distance from a loop closure [m] within which
# keyframes are known.
_REVISIT_PATH, _KNOWN = 60.0, 6.0
# Largest difference of two poses at one place, metres and radians.
_SAME_XY, _SAME_YAW = 3.0, 0.15
# Path to each side on which queries may be consistent, and largest distance of the places that they name [m].
_REACH, _MAX_PLACE_PATH = 30.0, 55.0
# Their largest difference: metres and radians, and the same per metre of path.
_ERROR, _TURN, _ERROR_RATE, _TURN_RATE = 0.8, 0.06, 0.02, 0.002
# Least number of consistent queries, and the factor by which it exceeds that of any other place.
_MIN_QUERIES, _MIN_RATIO = 14, 1.5
# Information of a hypothesis (1 m, 0.05 rad), and the chi-square by which the graph may be off: that of one
# in a thousand, with three degrees of freedom.
_HYPOTHESIS_INFORMATION, _MAX_CHI_SQUARE = np.diag([1.0, 1.0, 0.05**-2]), 16.3


def recognize_sequences(
    poses: np.ndarray, edges: Edges, clouds: Sequence[PointCloud], trajectory: TrackedTrajectory
) -> List[PlaceHypothesis]:
    """Recognize revisited places that have no loop closure nearby.

    Args:
        poses: (N, 3), poses of all keyframes in the map frame, optimized.
        edges: Edges of the graph.
        clouds: Points of all keyframes, each in its base frame.
        trajectory: Trajectory of the front end.

    Returns:
        For each query the best hypothesis, if it is consistent along a long path, differs from the graph, and
        is possible given the graph's covariance.
    """
    rows = _query_all(clouds, trajectory, edges.nodes[edges.is_loop, 1])
    nodes, measured = rows[:, :2].astype(np.int64), rows[:, 2:5]
    counts = _count_consistent(nodes, measured, trajectory.poses, trajectory.travelled)
    recent_poses = compose_poses(poses[nodes[:, 0]], measured)
    best: List[PlaceHypothesis] = []
    for recent in np.unique(nodes[counts >= _MIN_QUERIES, 1]).tolist():
        numbers = np.flatnonzero(nodes[:, 1] == recent)
        first = numbers[np.argmax(counts[numbers])]
        others = numbers[_are_elsewhere(recent_poses[numbers], recent_poses[first])]
        if _MIN_RATIO * counts[others].max(initial=0) <= counts[first]:
            place, similarity = int(nodes[first, 0]), float(rows[first, 5])
            best.append(PlaceHypothesis(place, recent, Pose2.from_array(measured[first]), similarity))
    return [each for each in best if _is_new_and_possible(each, poses, edges)]


def _query_all(clouds: Sequence[PointCloud], trajectory: TrackedTrajectory, closed: np.ndarray) -> np.ndarray:
    """Compare each place with those visited long before, except places near the ``closed`` keyframes.

    Returns:
        Rows (N, 6): place, recent keyframe, the latter's x, y and yaw in the former, similarity. As rows they
        take a tenth of the memory of objects.
    """
    places = descriptors_along(clouds, trajectory.poses, trajectory.travelled)
    travelled = trajectory.travelled
    rows = [np.empty((0, 6))]
    for place in places:
        if np.abs(travelled[closed] - travelled[place.keyframe]).min(initial=np.inf) > _KNOWN:
            end = travelled[place.keyframe] - _REVISIT_PATH
            found = match_places(place, [each for each in places if travelled[each.keyframe] < end])
            table = [
                (one.place, one.recent, *one.recent_in_place.as_array(), one.similarity) for one in found
            ]
            rows.append(np.array(table).reshape(-1, 6))
    return np.concatenate(rows)


def _are_elsewhere(poses: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Which of some poses (N, 3) are not at the same place as a pose (3,)."""
    distance = np.hypot(*(poses[:, :2] - pose[:2]).T)
    return (distance > _SAME_XY) | (np.abs(wrap(poses[:, 2] - pose[2])) > _SAME_YAW)


def _is_new_and_possible(hypothesis: PlaceHypothesis, poses: np.ndarray, edges: Edges) -> bool:
    """Whether a hypothesis differs from the graph, and is possible by the graph's covariance.

    Hypotheses between identical buildings are consistent along any path as well.
    """
    place, recent = hypothesis.place, hypothesis.recent
    edge = Edge(place, recent, hypothesis.recent_in_place, _HYPOTHESIS_INFORMATION)
    estimated = relative_pose(poses, place, recent).as_array()
    if not _are_elsewhere(edge.second_in_first.as_array()[None], estimated)[0]:
        return False
    return not NodeCovariance(poses, edges, recent).is_outlier(edge, _MAX_CHI_SQUARE)


def _count_consistent(
    nodes: np.ndarray, measured: np.ndarray, poses: np.ndarray, travelled: np.ndarray
) -> np.ndarray:
    """Count the queries around each hypothesis that have a consistent one.

    Args:
        nodes: (N, 2), place and recent keyframe, in the order of the latter.
        measured: (N, 3), recent keyframe in the place.
        poses: (K, 3), poses of all keyframes in the track frame.
        travelled: (K,), path length up to each keyframe [m].

    Returns:
        (N,).
    """
    by_hypothesis = compose_poses(poses[nodes[:, 0]], measured)
    return _counts(nodes[:, 1], travelled[nodes], poses[nodes[:, 1]], by_hypothesis)


@numba.njit(cache=True, nogil=True)
def _counts(recents, travelled, tracked, by_hypothesis):
    """Kernel of _count_consistent.

    Args:
        recents: (N,), indices of the recent keyframes.
        travelled: (N, 2), path length up to place and recent keyframe [m].
        tracked: (N, 3), poses of the recent keyframes in the track frame.
        by_hypothesis: (N, 3), the same according to each hypothesis.
    """
    counts = np.zeros(len(recents), dtype=np.int64)
    start = 0
    for i in range(len(recents)):
        while travelled[start, 1] < travelled[i, 1] - _REACH:
            start += 1
        turn = by_hypothesis[i, 2] - tracked[i, 2]
        c, s = math.cos(turn), math.sin(turn)
        last = recents[i]
        for j in range(start, len(recents)):
            if travelled[j, 1] > travelled[i, 1] + _REACH:
                break
            place_path = abs(travelled[j, 0] - travelled[i, 0])
            if recents[j] == recents[i] or recents[j] == last or place_path > _MAX_PLACE_PATH:
                continue
            dx, dy = tracked[j, 0] - tracked[i, 0], tracked[j, 1] - tracked[i, 1]
            error = math.hypot(
                by_hypothesis[i, 0] + c * dx - s * dy - by_hypothesis[j, 0],
                by_hypothesis[i, 1] + s * dx + c * dy - by_hypothesis[j, 1],
            )
            turned = turn - by_hypothesis[j, 2] + tracked[j, 2]
            turned = abs(math.atan2(math.sin(turned), math.cos(turned)))
            path = abs(travelled[j, 1] - travelled[i, 1]) + place_path
            if error < _ERROR + _ERROR_RATE * path and turned < _TURN + _TURN_RATE * path:
                counts[i] += 1
                last = recents[j]
    return counts
