"""Relocalization: finding the robot in a map without an initial pose.

A pose is accepted if the scans match there and nowhere else. The map is searched around places all over it,
in every direction, by branch and bound (W. Hess et al., "Real-time loop closure in 2D LIDAR SLAM", ICRA
2016). Maps with too many places for that rely on place recognition while the robot drives.
"""

import math
from typing import List, Optional, Sequence

import numpy as np

from planar import Pose2, wrap
from slam_lite.graph.pose_graph import Edge
from slam_lite.loops.loop_candidates import LoopCandidate
from slam_lite.loops.loop_closure import LoopClosure
from slam_lite.loops.visibility import PosedCloud, visibility_conflict
from slam_lite.matching.correlative import Peak, SearchWindow, search_branch_and_bound
from slam_lite.matching.local_map import LocalMap
from slam_lite.matching.refinement import refine
from slam_lite.point_cloud import PointCloud, downsampled, merge_clouds

# Distance between places [m], window searched around each, and number of places that are searched at most.
_APART, _WINDOW, _MAX_PLACES = 4.0, SearchWindow(3.5, math.pi), 60
# Distance from a place [m] within which keyframes are matched to, and their largest number.
_RADIUS, _MAX_KEYFRAMES = 8.0, 60
_MAX_POINTS, _MIN_POINTS = 500, 50
# Least response, and largest fraction of the walls that may be seen through: furniture moves.
_MIN_RESPONSE, _MAX_VISIBILITY_CONFLICT = 0.65, 0.15
# Share of the best score that makes another pose a rival; poses within these, metres and radians, are one.
_RIVAL_SHARE, _SAME_PLACE, _SAME_HEADING = 0.9, 0.6, 0.5
# Information of a pose from relocalization: standard deviations of 0.05 m and 0.02 rad.
_INFORMATION = np.diag([0.05**-2, 0.05**-2, 0.02**-2])
# Window around the prior pose, which is searched first.
_PRIOR_WINDOW = SearchWindow(1.0, 0.4)


class Relocalizer:
    """Global search for the robot among the keyframes of a map."""

    def __init__(self, clouds: Sequence[PointCloud], poses: np.ndarray, local_map: LocalMap):
        """Set the map.

        Args:
            clouds: Points of the keyframes, each in its base frame.
            poses: (N, 3), poses of the keyframes in the map frame.
            local_map: Working memory; overwritten.
        """
        self._clouds, self._poses, self._local_map = clouds, poses, local_map

    def find_pose(self, recent: Sequence[PosedCloud], prior: Optional[Pose2] = None) -> Optional[Pose2]:
        """Search the whole map.

        Args:
            recent: Last scans of the robot, each with its pose in the robot's present frame.
            prior: Pose in the map frame around which to search first.

        Returns:
            Robot pose in the map frame, None if there is no unique match.
        """
        cloud = downsampled(merge_clouds(recent), _MAX_POINTS)
        if len(cloud) < _MIN_POINTS or len(self._poses) == 0:
            return None
        pose = None if prior is None else self.find_pose_near(recent, prior)
        if pose is not None:
            return pose
        places = spread_places(self._poses, _APART)
        if len(places) > _MAX_PLACES:
            return None
        peaks = [self._search(cloud, Pose2(*self._poses[place, :2]), _WINDOW) for place in places]
        return self._verify(_unique_peak(peaks), cloud, recent)

    def find_pose_near(self, recent: Sequence[PosedCloud], prior: Pose2) -> Optional[Pose2]:
        """Search around a pose only.

        Args:
            recent: Last scans of the robot, each with its pose in the robot's present frame.
            prior: Pose in the map frame around which to search.

        Returns:
            Robot pose in the map frame, None if there is no unique match.
        """
        cloud = downsampled(merge_clouds(recent), _MAX_POINTS)
        if len(cloud) < _MIN_POINTS:
            return None
        return self._verify(self._search(cloud, prior, _PRIOR_WINDOW), cloud, recent)

    def find_loop_closure(
        self, clouds: Sequence[PointCloud], poses: np.ndarray, recent_keyframes: int
    ) -> Optional[LoopClosure]:
        """Find the loop closure that joins a separate trajectory with the map.

        Args:
            clouds: Points of the map's keyframes and those of the trajectory, each in its base frame.
            poses: (M, 3), poses of all of them in the map frame.
            recent_keyframes: Number of last keyframes that are merged for the search.

        Returns:
            The loop closure, None if there is no unique match.
        """
        last = len(poses) - 1
        map_in_last = Pose2.from_array(poses[last]).inverse()
        keyframes = range(last - recent_keyframes + 1, last + 1)
        in_map = self.find_pose([(clouds[i], map_in_last @ Pose2.from_array(poses[i])) for i in keyframes])
        if in_map is None:
            return None
        place = int(np.argmin(np.hypot(*(self._poses[:, :2] - [in_map.x, in_map.y]).T)))
        in_place = Pose2.from_array(self._poses[place]).inverse() @ in_map
        edge = Edge(place, last, in_place, _INFORMATION, is_loop=True)
        candidate = LoopCandidate(place, last, recent_keyframes, _WINDOW, 1.0, in_place)
        return LoopClosure(edge, candidate, np.zeros(2))

    def _search(self, cloud: PointCloud, center: Pose2, window: SearchWindow) -> Optional[Peak]:
        self._collect_around(center)
        sample, min_score = downsampled(cloud, 200), 0.7 * _MIN_RESPONSE
        return search_branch_and_bound(sample, self._local_map, center, window, min_score, _SAME_PLACE)

    def _verify(
        self, peak: Optional[Peak], cloud: PointCloud, recent: Sequence[PosedCloud]
    ) -> Optional[Pose2]:
        """The pose of a unique peak, if the scans match there and do not see through walls."""
        if peak is None or not peak.is_unique or peak.degenerate_direction.any():
            return None
        place = self._collect_around(peak.base_pose)
        match = refine(cloud, self._local_map, peak.base_pose, peak.base_pose, np.zeros((3, 3)))
        if match.response < _MIN_RESPONSE:
            return None
        conflict = visibility_conflict(place, recent, match.base_pose)
        return match.base_pose if conflict <= _MAX_VISIBILITY_CONFLICT else None

    def _collect_around(self, center: Pose2) -> List[PosedCloud]:
        """Put the keyframes around ``center`` into the local map, and return them."""
        near = np.flatnonzero(np.hypot(*(self._poses[:, :2] - [center.x, center.y]).T) < _RADIUS)
        near = near[:: -(-len(near) // _MAX_KEYFRAMES) or 1]
        posed = [(self._clouds[i], Pose2.from_array(self._poses[i])) for i in near]
        self._local_map.clear(center)
        for cloud, pose in posed:
            self._local_map.add(cloud, pose)
        return posed


def spread_places(poses: np.ndarray, apart: float) -> List[int]:
    """Choose keyframes that are apart from each other and cover all others.

    Args:
        poses: (N, 3), poses of the keyframes in the map frame.
        apart: Least distance between chosen keyframes, and largest from any other keyframe to one of them
            [m].

    Returns:
        Indices of the chosen keyframes.
    """
    chosen: List[int] = []
    distances = np.full(len(poses), np.inf)
    while len(distances) and distances.max() > apart:
        farthest = int(np.argmax(distances))
        chosen.append(farthest)
        distances = np.minimum(distances, np.hypot(*(poses[:, :2] - poses[farthest, :2]).T))
    return chosen


def _unique_peak(peaks: Sequence[Optional[Peak]]) -> Optional[Peak]:
    """The best peak, if no peak elsewhere scores nearly as well."""
    found = sorted((peak for peak in peaks if peak is not None), key=lambda peak: -peak.score)
    for other in found[1:]:
        is_same = (
            other.base_pose.distance_to(found[0].base_pose) < _SAME_PLACE
            and abs(wrap(other.base_pose.yaw - found[0].base_pose.yaw)) < _SAME_HEADING
        )
        if not is_same and other.score > _RIVAL_SHARE * found[0].score:
            return None
    return found[0] if found else None
