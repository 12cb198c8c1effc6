"""Loop closures along revisited segments: long segments are matched to each other, after the last scan.

Where little is seen, and from the opposite side, as on the return through a yard of trees, the few scans of a
usual loop closure do not match. Scans of about thirty metres do match, merged in a coarse grid that ignores
the side of a wall. They are merged along the trajectory of the front end, because the optimized graph spreads
the error of a single wheel slip evenly over many steps.
"""

from typing import List, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np

from planar import Pose2
from slam_lite.graph.pose_graph import Edge, Edges, relative_pose
from slam_lite.loops.cycle_consistency import cycle_error
from slam_lite.loops.sequence_recognition import recognize_sequences
from slam_lite.loops.static_points import static_points
from slam_lite.loops.tracked_trajectory import TrackedTrajectory, tracked_trajectory
from slam_lite.loops.visibility import PosedCloud
from slam_lite.matching.correlative import SearchWindow, score_poses, search_branch_and_bound
from slam_lite.matching.local_map import LocalMap
from slam_lite.point_cloud import PointCloud, downsampled

# Path between two searches; distance of a place by the graph, and path since it was visited [m].
_SEARCH_STEP, _NEAR, _REVISIT_PATH = 3.0, 5.0, 60.0
# Number of keyframes between two different places, and distance from a loop closure [m] within which a place
# is known.
_KEYFRAMES_APART, _KNOWN = 30, 6.0
# Path for which a loop closure predicts the robot's pose [m].
_PREDICTION_PATH = 40.0
# Path to each side of the recent keyframe, and of the place [m]; of the former so many scans at most.
_RECENT_PATH, _PLACE_PATH = 14.0, 20.0
_MAX_SCANS = 60
_MIN_POINTS, _MAX_POINTS = 200, 400
# Windows that are searched in turn, with the least score; matches nearer to each other than this [m] are one.
_SEARCHES, _APART = ((SearchWindow(3.0, 0.15), 0.3), (SearchWindow(6.0, 0.3), 0.5)), 0.6
# Poses around the best one that are weighted by their score, and the softness of the weights.
_STEPS_XY, _STEPS_YAW = np.arange(-1.0, 1.05, 0.2), np.arange(-0.12, 0.125, 0.02)
_SOFTNESS = 0.1
# Largest standard deviations of a match, metres and radians, in its best direction; from which on [m] it is
# degenerate in the worst one, the standard deviation [m] added to it then, and those always added.
_MAX_XY, _MAX_YAW, _DEGENERATE, _DEGENERATE_SIGMA = 0.35, 0.04, 0.4, 1.0
_ADDED_XY, _ADDED_YAW = 0.1, 0.008
# A vaguer match, up to these, closes no loop, but predicts the next one.
_VAGUE_XY, _VAGUE_YAW = 0.45, 0.055
# Number of consistent matches that confirm one, their distances along the two segments [m], and their largest
# difference: metres and radians, and the same per metre of path.
_WITNESSES, _RECENT_APART, _PLACE_APART = 2, (2.0, 20.0), 25.0
_ERROR, _TURN, _ERROR_RATE, _TURN_RATE = 0.35, 0.05, 0.015, 0.001


def match_revisited_segments(
    poses: np.ndarray, edges: Edges, clouds: Sequence[PointCloud], local_map: LocalMap
) -> List[Edge]:
    """Find loop closures where an optimized graph has none.

    Args:
        poses: (N, 3), poses of all keyframes in the map frame.
        edges: Edges of the graph.
        clouds: Points of all keyframes, each in its base frame.
        local_map: Working memory; overwritten.

    Returns:
        The verified loop edges.
    """
    if len(poses) < 2:
        return []
    search = _SegmentSearch(poses, edges, clouds, local_map)
    found = search.run()
    trajectory = search.trajectory
    return [edge for edge in found if sum(_agree(edge, other, trajectory) for other in found) >= _WITNESSES]


class _SegmentMatch(NamedTuple):
    """A match of two segments, and whether it is precise enough to close a loop."""

    edge: Edge
    is_precise: bool


class _SegmentSearch:
    """Searches along the trajectory, forwards and backwards, for segments that were driven before.

    Where to search is predicted by the nearest loop closure and the path since; without one, by place
    recognition along a long path, or by the graph.
    """

    def __init__(self, poses: np.ndarray, edges: Edges, clouds: Sequence[PointCloud], local_map: LocalMap):
        self.trajectory = tracked_trajectory(poses[0], edges)
        self._poses, self._clouds, self._local_map = poses, clouds, local_map
        # Loop closures of the graph, and then the matches found.
        self._loops = [edges[number] for number in np.flatnonzero(edges.is_loop)]
        self._graph_loop_count = len(self._loops)
        self._tried: Set[Tuple[int, int]] = set()
        self._recognized = recognize_sequences(poses, edges, clouds, self.trajectory)

    def run(self) -> List[Edge]:
        """Return all precise matches, also those that nothing confirms."""
        precise: List[Edge] = []
        steps = np.floor(self.trajectory.travelled / _SEARCH_STEP)
        recents = np.flatnonzero(np.diff(steps, prepend=-1.0)).tolist()
        for recent in (*recents, *reversed(recents)):
            for place, guess in self._candidates(recent):
                if (place, recent) not in self._tried:
                    self._tried.add((place, recent))
                    match = _match_segments(
                        place, recent, guess, self.trajectory, self._clouds, self._local_map
                    )
                    self._loops += [] if match is None else [match.edge]
                    precise += [match.edge] if match is not None and match.is_precise else []
        return precise

    def _candidates(self, recent: int) -> List[Tuple[int, Pose2]]:
        """Places that the robot may have visited before, with the pose of ``recent`` in each."""
        numbers, candidates = self._nearest_loops(recent), []
        for number in numbers:
            loop = self._loops[number]
            is_of_graph = number < self._graph_loop_count
            is_known = is_of_graph and self.trajectory.path_length(loop.second, recent) < _KNOWN
            predicted = None if is_known else self._predicted_by(loop, recent)
            candidates += [] if predicted is None else [predicted]
        for place, guess in (*self._recognized_at(recent), *self._near_by_graph(recent)):
            if all(self._is_apart(self._loops[number].first, place) for number in numbers):
                candidates.append((place, guess))
        return candidates

    def _recognized_at(self, recent: int) -> List[Tuple[int, Pose2]]:
        """Places recognized within half a search step of a keyframe."""
        return [
            (each.place, each.recent_in_place @ self.trajectory.between(each.recent, recent))
            for each in self._recognized
            if self.trajectory.path_length(each.recent, recent) < 0.5 * _SEARCH_STEP
        ]

    def _nearest_loops(self, recent: int) -> List[int]:
        """Numbers of the nearest loop closures along the path, one for each segment of places."""
        nodes = np.array([(loop.first, loop.second) for loop in self._loops], dtype=np.int64).reshape(-1, 2)
        travelled = self.trajectory.travelled
        paths = np.abs(travelled[nodes[:, 1]] - travelled[recent])
        nearest: List[int] = []
        count = np.count_nonzero(paths <= _PREDICTION_PATH)
        for number in np.argsort(paths, kind="stable")[:count].tolist():
            others = (self._loops[other].first for other in nearest)
            if all(self._is_apart(self._loops[number].first, other) for other in others):
                nearest.append(number)
        return nearest

    def _is_apart(self, first: int, second: int) -> bool:
        """Whether two keyframes are on different segments."""
        return self.trajectory.path_length(first, second) > 2.0 * _PREDICTION_PATH

    def _predicted_by(self, loop: Edge, recent: int) -> Optional[Tuple[int, Pose2]]:
        """The place nearest to the robot by a loop closure and the path since, with its pose there."""
        start, end = self.trajectory.within(loop.first, 2.0 * _PREDICTION_PATH)
        end = min(end, self._end_of_places(recent) - 1)
        if end < start:
            return None
        robot = Pose2.from_array(self.trajectory.poses[loop.first]) @ loop.second_in_first
        robot = robot @ self.trajectory.between(loop.second, recent)
        distances = np.hypot(*(self.trajectory.poses[start : end + 1, :2] - [robot.x, robot.y]).T)
        place = start + int(np.argmin(distances))
        if distances.min() > _NEAR:
            return None
        return place, Pose2.from_array(self.trajectory.poses[place]).inverse() @ robot

    def _near_by_graph(self, recent: int) -> List[Tuple[int, Pose2]]:
        """The nearest place of each segment that is near by the graph."""
        distances = np.hypot(*(self._poses[: self._end_of_places(recent), :2] - self._poses[recent, :2]).T)
        near = np.flatnonzero(distances < _NEAR)
        segments = np.split(near, np.flatnonzero(np.diff(near) > _KEYFRAMES_APART) + 1)
        places = [int(segment[np.argmin(distances[segment])]) for segment in segments if len(segment)]
        return [(place, relative_pose(self._poses, place, recent)) for place in places]

    def _end_of_places(self, recent: int) -> int:
        """The first keyframe that is too near along the path to be an earlier visit."""
        travelled = self.trajectory.travelled
        return int(np.searchsorted(travelled, travelled[recent] - _REVISIT_PATH))


def _match_segments(
    place: int,
    recent: int,
    guess: Pose2,
    trajectory: TrackedTrajectory,
    clouds: Sequence[PointCloud],
    local_map: LocalMap,
) -> Optional[_SegmentMatch]:
    """Match the segments around two keyframes, if they match in one way only."""
    first, last = trajectory.within(recent, _RECENT_PATH)
    recent_clouds = _posed_clouds(first, last, recent, trajectory, clouds)
    points = static_points(recent_clouds[:: max(1, len(recent_clouds) // _MAX_SCANS)])
    if len(points) < _MIN_POINTS:
        return None
    start, end = trajectory.within(place, _PLACE_PATH)
    local_map.clear(Pose2())
    for posed in _posed_clouds(start, min(end, first - 1), place, trajectory, clouds):
        local_map.add(*posed)
    coarse, sample = local_map.coarse_map or local_map, downsampled(points, _MAX_POINTS)
    for window, min_score in _SEARCHES:
        peak = search_branch_and_bound(sample, coarse, guess, window, min_score, apart=_APART)
        if peak is not None:
            break
    if peak is None or not peak.is_unique:
        return None
    mean, covariance = _weighted_mean(peak.base_pose, sample, coarse)
    if not _is_within(covariance, _VAGUE_XY, _VAGUE_YAW):
        return None
    edge = Edge(place, recent, mean, _information(covariance), is_loop=True)
    return _SegmentMatch(edge, _is_within(covariance, _MAX_XY, _MAX_YAW))


def _weighted_mean(peak: Pose2, cloud: PointCloud, local_map: LocalMap) -> Tuple[Pose2, np.ndarray]:
    """Mean and covariance (3, 3) of the poses around a peak, weighted by their scores.

    After E. Olson, "Real-time correlative scan matching", ICRA 2009.
    """
    poses = np.stack(np.meshgrid(_STEPS_XY, _STEPS_XY, _STEPS_YAW, indexing="ij"), -1).reshape(-1, 3)
    poses += peak.as_array()
    scores = score_poses(cloud, local_map, [Pose2.from_array(pose) for pose in poses])
    weights = np.exp((scores / scores.max() - 1.0) / _SOFTNESS)
    mean = np.average(poses, axis=0, weights=weights)
    return Pose2.from_array(mean), np.cov(poses.T, aweights=weights, ddof=0)


def _is_within(covariance: np.ndarray, xy: float, yaw: float) -> bool:
    """Whether the standard deviations of a match are within bounds, in its best direction."""
    return bool(np.linalg.eigvalsh(covariance[:2, :2])[0] <= xy**2 and covariance[2, 2] <= yaw**2)


def _information(covariance: np.ndarray) -> np.ndarray:
    """Information (3, 3) of a match that may be degenerate, with errors that its scores do not show."""
    total = covariance + np.diag([_ADDED_XY**2, _ADDED_XY**2, _ADDED_YAW**2])
    (_, largest), axes = np.linalg.eigh(covariance[:2, :2])
    if largest > _DEGENERATE**2:
        total[:2, :2] += _DEGENERATE_SIGMA**2 * np.outer(axes[:, 1], axes[:, 1])
    return np.linalg.inv(total)


def _agree(one: Edge, other: Edge, trajectory: TrackedTrajectory) -> bool:
    """Whether two matches near each other are consistent, except along their degenerate directions."""
    recent_path = trajectory.path_length(one.second, other.second)
    place_path = trajectory.path_length(one.first, other.first)
    if not _RECENT_APART[0] < recent_path < _RECENT_APART[1] or place_path > _PLACE_APART:
        return False
    error, turn = cycle_error(
        one,
        other,
        trajectory.between(one.second, other.second),
        trajectory.between(one.first, other.first),
        _degenerate_direction(one),
        _degenerate_direction(other),
    )
    path = recent_path + place_path
    return error < _ERROR + _ERROR_RATE * path and turn < _TURN + _TURN_RATE * path


def _degenerate_direction(edge: Edge) -> np.ndarray:
    """Unit vector (2,), along first's axes, in which an edge has little information, or zeros."""
    (_, largest), axes = np.linalg.eigh(np.linalg.inv(edge.information)[:2, :2])
    return axes[:, 1] if largest > _DEGENERATE**2 + 0.5 * _DEGENERATE_SIGMA**2 else np.zeros(2)


def _posed_clouds(
    first: int, last: int, origin: int, trajectory: TrackedTrajectory, clouds: Sequence[PointCloud]
) -> List[PosedCloud]:
    """Keyframes, each with its pose in that of ``origin``."""
    return [(clouds[i], trajectory.between(origin, i)) for i in range(first, last + 1)]
