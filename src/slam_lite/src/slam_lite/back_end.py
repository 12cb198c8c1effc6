"""The back end: the pose graph of keyframes, and the search for loop closures in it.

A search is a task that holds all its inputs by value, so that it can run in another thread while the front
end continues:

    result = back_end.closure_task().run()
    back_end.apply_closures(result)
"""

from dataclasses import dataclass
from typing import Iterator, List, Optional, Sequence, Tuple

import numpy as np

from planar import Pose2, wrap
from slam_lite.config import MapperSettings
from slam_lite.graph.drift import drift_along, shortest_paths, with_average_slip
from slam_lite.graph.pose_graph import (
    COARSE,
    FINE,
    Edge,
    EdgeList,
    Edges,
    chi_squares,
    concatenate,
    deflate,
    edges_of,
    inflate,
    optimize,
    relative_pose,
)
from slam_lite.loops.loop_candidates import (
    LoopCandidate,
    are_outside_search_windows,
    candidate_at_recognized_place,
    count_alternatives,
    edge_lengths,
    is_within_drift,
    loop_candidates,
)
from slam_lite.loops.loop_closure import SIGMA_XY, SIGMA_YAW, LoopClosure, LoopClosureVerifier
from slam_lite.loops.loop_search import find_loop_closure
from slam_lite.loops.place_recognition import (
    PlaceDatabase,
    PlaceDescriptor,
    PlaceHypothesis,
    database_of_map,
    match_places,
    travelled_distances,
)
from slam_lite.loops.relocalization import Relocalizer
from slam_lite.loops.revisited_segments import match_revisited_segments
from slam_lite.matching.local_map import LocalMap, long_range_map
from slam_lite.point_cloud import PointCloud, without_far_points

# Errors of a step between consecutive keyframes that its match does not include: metres and radians.
_STEP_SIGMA_XY, _STEP_SIGMA_YAW = 0.01, 0.003
# Shares of the variances added to steps and to loop closures (x, y, yaw) that exceed the errors measured
# on simulated logs: the search for loop closures has to be cautious, the final poses have not.
_STEP_EXCESS, _LOOP_EXCESS = np.array([0.75, 0.75, 0.75]), np.array([0.0, 0.0, 0.75])
# Standard deviations of the pose at which a robot resumes in a saved map, and of an unknown pose.
_GUESS_SIGMA_XY, _GUESS_SIGMA_YAW = 0.5, 0.3
_LOST_SIGMA_XY, _LOST_SIGMA_YAW = 1e3, 1e2
# Keyframes that are merged to relocalize a lost robot, and its distance from the map until then [m].
_LOST_KEYFRAMES, _DISTANCE_BESIDE_MAP = 20, 30.0
# A new loop closure with a larger chi-square, or this many smaller ones, trigger an optimization.
_NEWS_CHI_SQUARE, _NEWS_COUNT = 10.0, 20
_MAX_PENDING = 50
# Recognized places that are searched for a loop closure, of one query.
_MAX_RECOGNIZED = 3
# Passes of the search along revisited segments, and the chi-square from which on a loop closure is dropped.
_REVISIT_PASSES, _MAX_FINAL_CHI_SQUARE = 2, 16.0


@dataclass(frozen=True, eq=False)
class ClosureResult:
    """Result of a closure task.

    Attributes:
        edges: New loop edges.
        poses: (N, 3), poses of the task's keyframes in the map frame, rows ``[x, y, yaw]``.
        pending: Loop closures that are not verified yet, for the next task.
        places: Place descriptors, for the next task.
        moved: Whether ``poses`` were optimized; otherwise they are those of the task.
    """

    edges: Sequence[Edge]
    poses: np.ndarray
    pending: Sequence[LoopClosure]
    places: PlaceDatabase
    moved: bool


@dataclass(frozen=True, eq=False)
class ClosureTask:
    """Search for loop closures of the newest keyframe, with optimization if they change the graph.

    Attributes:
        settings: Settings of the loop closure search.
        local_map: Working memory for the points around a candidate; overwritten.
        clouds: Points of all keyframes, each in its base frame.
        poses: (N, 3), poses of all keyframes in the map frame, rows ``[x, y, yaw]``.
        edges: Edges of the pose graph.
        pending: Loop closures that are not verified yet.
        places: Place descriptors so far.
        unsettled: Number of loop edges since the last optimization.
        lost_since: First keyframe of a trajectory that is not joined with the map yet; None if all are
            joined.
    """

    settings: MapperSettings
    local_map: LocalMap
    clouds: Sequence[PointCloud]
    poses: np.ndarray
    edges: Edges
    pending: Sequence[LoopClosure]
    places: PlaceDatabase
    unsettled: int
    lost_since: Optional[int]

    def run(self) -> ClosureResult:
        """Search, verify and optimize; only ``local_map`` is modified."""
        accepted: List[LoopClosure] = []
        pending = list(self.pending)
        verifier = LoopClosureVerifier(self.poses, self.edges)
        places, recognized = self._recognize_places()
        for closure in self._find_loop_closures(recognized, verifier):
            verified = verifier.verify(closure, pending)
            if verified:
                accepted += verified
                pending = [other for other in pending if other not in verified]
            else:
                pending = [*pending[1 - _MAX_PENDING :], closure]
        edges = [closure.graph_edge for closure in accepted]
        if not self._needs_optimization(edges):
            return ClosureResult(edges, self.poses, pending, places, False)
        poses = optimize(self._joined(edges), concatenate(self.edges, edges), COARSE, new_count=len(edges))
        return ClosureResult(edges, poses, pending, places, True)

    def _find_loop_closures(
        self, recognized: Sequence[LoopCandidate], verifier: LoopClosureVerifier
    ) -> Iterator[LoopClosure]:
        """All loop closures of the newest keyframe, before they are verified."""
        nearby = loop_candidates(len(self.poses) - 1, self.poses, self.edges, self.settings)
        for candidate in (*nearby, *recognized):
            closure = find_loop_closure(candidate, self.poses, self.clouds, self.local_map, self.settings)
            if closure is not None:
                yield verifier.check_against_graph(closure)
        if self.lost_since is not None:
            known = slice(self.lost_since)
            relocalizer = Relocalizer(self.clouds[known], self.poses[known], self.local_map)
            count = min(_LOST_KEYFRAMES, len(self.poses) - self.lost_since)
            closure = relocalizer.find_loop_closure(self.clouds, self.poses, count)
            if closure is not None:
                yield closure

    def _joined(self, edges: Sequence[Edge]) -> np.ndarray:
        """Return the poses (N, 3), with a lost trajectory moved as one of ``edges`` requires."""
        for edge in edges:
            if self.lost_since is not None and edge.first < self.lost_since <= edge.second:
                place, recent = (Pose2.from_array(self.poses[i]) for i in (edge.first, edge.second))
                move = place @ edge.second_in_first @ recent.inverse()
                poses = self.poses.copy()
                poses[self.lost_since :, :2] = move.transform_points(poses[self.lost_since :, :2])
                poses[self.lost_since :, 2] = wrap(poses[self.lost_since :, 2] + move.yaw)
                return poses
        return self.poses

    def _recognize_places(self) -> Tuple[PlaceDatabase, List[LoopCandidate]]:
        """Return the place descriptors up to the newest keyframe, and candidates at similar places."""
        places, travelled = self.places, travelled_distances(self.poses)
        candidates: List[LoopCandidate] = []
        segment = places.next_segment(travelled)
        while segment is not None:
            descriptor = segment.descriptor(self.clouds, self.poses)
            hypotheses: List[PlaceHypothesis] = []
            alternatives = 1.0
            if descriptor is not None:
                hypotheses, alternatives = self._match_credible_places(descriptor, places)
            confirmed = places.confirmed(hypotheses, self.poses)
            step = relative_pose(self.poses, segment.middle, segment.last)
            count = segment.last - segment.first + 1
            candidates = [
                candidate_at_recognized_place(
                    one.place, segment.last, count, one.recent_in_place @ step, alternatives
                )
                for one in confirmed[:_MAX_RECOGNIZED]
            ]
            places = places.extended(segment, descriptor, hypotheses)
            segment = places.next_segment(travelled)
        return places, candidates

    def _match_credible_places(
        self, recent: PlaceDescriptor, places: PlaceDatabase
    ) -> Tuple[List[PlaceHypothesis], float]:
        """Match places that the graph's drift allows, outside of the windows of the other search.

        Returns:
            The hypotheses, and the number of places and headings that were possible.
        """
        paths, before = shortest_paths(recent.keyframe, len(self.poses), self.edges, edge_lengths(self.edges))
        drift = np.column_stack(drift_along(paths, before, self.poses, with_average_slip(self.edges)))
        keyframes = [descriptor.keyframe for descriptor in places.descriptors]
        are_outside = are_outside_search_windows(paths[keyframes], drift[keyframes])
        outside = [each for each, is_outside in zip(places.descriptors, are_outside) if is_outside]
        indices = np.array([each.keyframe for each in outside], dtype=np.int64)
        hypotheses = [
            hypothesis
            for hypothesis in match_places(recent, outside)
            if is_within_drift(hypothesis, self.poses, drift[hypothesis.place])
        ]
        return hypotheses, count_alternatives(recent.keyframe, indices, self.poses, drift[indices])

    def _needs_optimization(self, edges: Sequence[Edge]) -> bool:
        if not edges:
            return False
        if self.unsettled + len(edges) >= _NEWS_COUNT:
            return True
        return bool(chi_squares(self.poses, edges_of(*edges)).max() > _NEWS_CHI_SQUARE)


class BackEnd:
    """Pose graph of the keyframes, which places them in the map.

    Attributes:
        clouds: Points of all keyframes, each in its base frame.
    """

    def __init__(self, settings: MapperSettings):
        """Create an empty graph.

        Args:
            settings: Settings of the loop closure search.
        """
        self._settings = settings
        self._local_map = long_range_map()
        self.clouds: List[PointCloud] = []
        self._edges = EdgeList()
        self._poses = np.empty((0, 3))
        self._pending: Sequence[LoopClosure] = ()
        self._places = PlaceDatabase()
        self._unsettled = 0
        self._lost_since: Optional[int] = None

    def __len__(self) -> int:
        return len(self.clouds)

    @property
    def poses(self) -> np.ndarray:
        """Poses (N, 3) of the keyframes in the map frame; a view that later calls modify."""
        return self._poses[: len(self)]

    @property
    def edges(self) -> Edges:
        """All edges of the graph."""
        return self._edges.view()

    def pose(self, keyframe: int) -> Pose2:
        """Pose of a keyframe in the map frame."""
        return Pose2.from_array(self._poses[keyframe])

    def relocalize(self, cloud: PointCloud, prior: Pose2, only_near: bool) -> Optional[Pose2]:
        """Find the pose of a scan in the map.

        Args:
            cloud: Points of the scan, in the base frame.
            prior: Pose of the base in the map frame around which to search first.
            only_near: Whether to search around ``prior`` only.

        Returns:
            Pose of the base in the map frame, None if there is no unique match.
        """
        relocalizer = Relocalizer(self.clouds, self.poses, self._local_map)
        recent = [(cloud, Pose2())]
        return (
            relocalizer.find_pose_near(recent, prior) if only_near else relocalizer.find_pose(recent, prior)
        )

    def pose_beside(self, cloud: PointCloud) -> Pose2:
        """Return a pose beside the map, in the map frame, from which a scan overlaps with nothing in it.

        Args:
            cloud: Points of the scan, in the base frame.
        """
        ends = [(pose[0] + _reach(other), pose[1]) for other, pose in zip(self.clouds, self.poses)]
        end, y = max(ends, default=(0.0, 0.0))
        return Pose2(end + _DISTANCE_BESIDE_MAP + _reach(cloud), y, 0.0)

    def add_first(self, cloud: PointCloud, base_in_map: Pose2, is_lost: bool = False) -> None:
        """Add the first keyframe of a trajectory.

        The edge from the last keyframe, if there is one, has a standard deviation of 0.5 m and 0.3 rad.

        Args:
            cloud: Points of the keyframe, in the base frame.
            base_in_map: Initial pose of the keyframe in the map frame.
            is_lost: Whether the robot's place in the map is unknown; then the edge has practically no
                information.
        """
        last_in_map = self.pose(len(self) - 1) if len(self) else None
        self._append(cloud, base_in_map)
        if last_in_map is not None:
            last = len(self) - 2
            xy, yaw = (_LOST_SIGMA_XY, _LOST_SIGMA_YAW) if is_lost else (_GUESS_SIGMA_XY, _GUESS_SIGMA_YAW)
            information = np.diag([xy**-2, xy**-2, yaw**-2])
            self._edges.append(Edge(last, last + 1, last_in_map.inverse() @ base_in_map, information))
            self._lost_since = last + 1 if is_lost else None
            self._places = self._places.with_new_trajectory(len(self) - 1)

    def restore(self, clouds: Sequence[PointCloud], poses: np.ndarray, edges: Edges) -> None:
        """Load the keyframes and edges of a saved graph into an empty one.

        Args:
            clouds: Points of the keyframes, each in its base frame.
            poses: (N, 3), poses of the keyframes in the map frame.
            edges: Edges between them.
        """
        self.clouds = list(clouds)
        self._poses = poses.copy()
        self._edges = EdgeList(edges)
        self._places = database_of_map(self.clouds, self.poses)

    def _append(self, cloud: PointCloud, base_in_map: Pose2) -> None:
        n = len(self)
        if n == len(self._poses):
            self._poses = np.concatenate((self._poses, np.empty((max(n, 64), 3))))
        self._poses[n] = base_in_map.as_array()
        self.clouds.append(cloud)

    def add(self, cloud: PointCloud, base_in_last: Pose2, information: np.ndarray) -> None:
        """Add a keyframe with an edge from the last one.

        Args:
            cloud: Points of the keyframe, in the base frame.
            base_in_last: Measured pose of the keyframe in the last one.
            information: (3, 3), of ``base_in_last`` along the axes of the last keyframe, 1 / (m, m, rad)^2.
        """
        last = len(self) - 1
        self._append(cloud, self.pose(last) @ base_in_last)
        edge = Edge(last, last + 1, base_in_last, information)
        self._edges.append(inflate(edge, _STEP_SIGMA_XY, _STEP_SIGMA_YAW))

    def closure_task(self) -> ClosureTask:
        """Return the loop closure search for the newest keyframe.

        Run one task at a time: tasks share a local map as working memory.
        """
        return ClosureTask(
            self._settings,
            self._local_map,
            tuple(self.clouds),
            self.poses.copy(),
            self.edges,
            self._pending,
            self._places,
            self._unsettled,
            self._lost_since,
        )

    def apply_closures(self, result: ClosureResult) -> None:
        """Apply the result of a closure task.

        Keyframes added since the task was created move rigidly with the last keyframe of the task.

        Args:
            result: Result of the last ``closure_task``.
        """
        known = len(result.poses)
        if result.moved:
            last = known - 1
            moved = Pose2.from_array(result.poses[last]) @ self.pose(last).inverse()
            for i in range(known, len(self)):
                self._poses[i] = (moved @ self.pose(i)).as_array()
            self._poses[:known] = result.poses
        for edge in result.edges:
            self._edges.append(edge)
            if self._lost_since is not None and edge.first < self._lost_since <= edge.second:
                self._lost_since = None
        self._pending = result.pending
        if known > self._places.start:  # otherwise a new trajectory has started since
            self._places = result.places
        self._unsettled = 0 if result.moved else self._unsettled + len(result.edges)

    def remove_far_points(self, keyframe: int, laser_xy: np.ndarray, max_range: float) -> None:
        """Remove the points of a keyframe beyond a range [m] from its laser (2,), in the base frame."""
        self.clouds[keyframe] = without_far_points(self.clouds[keyframe], laser_xy, max_range)

    def run_final_optimization(self) -> None:
        """Optimize to convergence, and close loops along revisited segments."""
        poses, found = optimize(self.poses, self.edges, FINE), []
        for _ in range(_REVISIT_PASSES if self._settings.close_loops else 0):
            found = match_revisited_segments(poses, self.edges, self.clouds, self._local_map)
            if not found:
                break
            poses = optimize(poses, concatenate(self.edges, found), FINE, new_count=len(found))
        for edge, chi in zip(found, chi_squares(poses, edges_of(*found))):
            if chi < _MAX_FINAL_CHI_SQUARE:
                self._edges.append(edge)
        self._poses[: len(self)] = optimize(poses, without_excess(self.edges), FINE)
        self._unsettled = 0


def without_excess(edges: Edges) -> Edges:
    """Return the edges with errors as large as they are, not as the search for loop closures assumes.

    Args:
        edges: Edges of the graph.
    """
    step = _STEP_EXCESS * np.square([_STEP_SIGMA_XY, _STEP_SIGMA_XY, _STEP_SIGMA_YAW])
    loop = _LOOP_EXCESS * np.square([SIGMA_XY, SIGMA_XY, SIGMA_YAW])
    return deflate(edges, np.where(edges.is_loop[:, None], loop, step))


def _reach(cloud: PointCloud) -> float:
    """Distance of the farthest point [m]."""
    return float(np.sqrt((cloud.points_xy**2).sum(axis=1).max(initial=0.0)))
