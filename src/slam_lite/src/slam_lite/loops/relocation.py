"""Finding the robot in a map without a guess: it is where its scans fit, if they fit nowhere else.

The map is searched from places all over it, in every direction, by branch and bound (W. Hess et al.,
"Real-time loop closure in 2D LIDAR SLAM", ICRA 2016). In maps of too many places for that, the robot has to
be recognised on its way.
"""

import math
from typing import List, Optional, Sequence

import numpy as np

from planar import Pose2, wrap
from slam_lite.graph.pose_graph import Edge
from slam_lite.loops.loop_closure import Candidate, Closure
from slam_lite.loops.sight import Placed, clash
from slam_lite.matching.correlative import Peak, Window, search_far
from slam_lite.matching.local_map import LocalMap
from slam_lite.matching.refinement import refine
from slam_lite.surface import Surface, joined, thinned

# Places are so far apart, metres, and searched so far around, in all directions; how many may be searched.
_APART, _WINDOW, _MOST_PLACES = 4.0, Window(3.5, math.pi), 60
# Scans of a place are taken from within this distance, metres, at most so many.
_RADIUS, _MOST_SCANS = 8.0, 60
_MOST_POINTS, _FEWEST_POINTS = 500, 50
# Share of the robot's scans that must fit, and of the walls that may be seen through: furniture moves.
_MIN_RESPONSE, _MAX_CLASH = 0.65, 0.15
# Elsewhere the scans must fit less than by this share of the best; poses so near, metres, radians, are one.
_RIVAL_SHARE, _SAME_PLACE, _SAME_HEADING = 0.9, 0.6, 0.5
# How sure a tie to the map is that was found so: 0.05 m and 0.02 rad.
_INFORMATION = np.diag([0.05**-2, 0.05**-2, 0.02**-2])
# How far from where it was last a robot is looked for first.
_BELIEVED = Window(1.0, 0.4)


class KnownMap:
    """Key scans at ``poses`` (N, 3), in which the robot is searched; ``local_map`` is overwritten."""

    def __init__(self, surfaces: Sequence[Surface], poses: np.ndarray, local_map: LocalMap):
        self._surfaces, self._poses, self._local_map = surfaces, poses, local_map

    def find(self, recent: Sequence[Placed], believed: Optional[Pose2] = None) -> Optional[Pose2]:
        """The robot's pose in the map, None if it cannot be told.

        ``recent``: its last scans, each with its pose as seen from the robot. ``believed``: where to look
        first.
        """
        surface = thinned(joined(recent), _MOST_POINTS)
        if len(surface) < _FEWEST_POINTS or len(self._poses) == 0:
            return None
        pose = None if believed is None else self.find_near(recent, believed)
        if pose is not None:
            return pose
        places = spread(self._poses, _APART)
        if len(places) > _MOST_PLACES:
            return None
        peaks = [self._peak(surface, Pose2(*self._poses[place, :2]), _WINDOW) for place in places]
        return self._confirmed(_only(peaks), surface, recent)

    def find_near(self, recent: Sequence[Placed], believed: Pose2) -> Optional[Pose2]:
        """The same, looked for around ``believed`` only."""
        surface = thinned(joined(recent), _MOST_POINTS)
        if len(surface) < _FEWEST_POINTS:
            return None
        return self._confirmed(self._peak(surface, believed, _BELIEVED), surface, recent)

    def closure(self, surfaces: Sequence[Surface], poses: np.ndarray, recent_keys: int) -> Optional[Closure]:
        """The tie to the map of the last of keys at ``poses`` (M, 3), found by the ``recent_keys`` last."""
        last = len(poses) - 1
        last_in_keys = Pose2.from_array(poses[last]).inverse()
        keys = range(last - recent_keys + 1, last + 1)
        in_map = self.find([(surfaces[key], last_in_keys @ Pose2.from_array(poses[key])) for key in keys])
        if in_map is None:
            return None
        place = int(np.argmin(np.hypot(*(self._poses[:, :2] - [in_map.x, in_map.y]).T)))
        in_place = Pose2.from_array(self._poses[place]).inverse() @ in_map
        edge = Edge(place, last, in_place, _INFORMATION, is_loop=True)
        return Closure(edge, Candidate(place, last, recent_keys, _WINDOW, 1.0, in_place), np.zeros(2))

    def _peak(self, surface: Surface, center: Pose2, window: Window) -> Optional[Peak]:
        self._gather(center)
        sample = thinned(surface, 200)
        return search_far(sample, self._local_map, center, window, 0.7 * _MIN_RESPONSE, _SAME_PLACE)

    def _confirmed(self, peak: Optional[Peak], surface: Surface, recent: Sequence[Placed]) -> Optional[Pose2]:
        """The pose of a peak that is the only one, if the scans fit there, also to what they see through."""
        if peak is None or not peak.is_unique or peak.slide.any():
            return None
        there = self._gather(peak.base_pose)
        match = refine(surface, self._local_map, peak.base_pose, peak.base_pose, np.zeros((3, 3)))
        if match.response < _MIN_RESPONSE or clash(there, recent, match.base_pose) > _MAX_CLASH:
            return None
        return match.base_pose

    def _gather(self, center: Pose2) -> List[Placed]:
        """Puts the scans around ``center`` into the local map."""
        near = np.flatnonzero(np.hypot(*(self._poses[:, :2] - [center.x, center.y]).T) < _RADIUS)
        near = near[:: -(-len(near) // _MOST_SCANS) or 1]
        placed = [(self._surfaces[key], Pose2.from_array(self._poses[key])) for key in near]
        self._local_map.clear(center)
        for surface, pose in placed:
            self._local_map.add(surface, pose)
        return placed


def spread(poses: np.ndarray, apart: float) -> List[int]:
    """Keys at poses (N, 3) that are ``apart`` metres from each other and leave no other one farther off."""
    chosen: List[int] = []
    distances = np.full(len(poses), np.inf)
    while len(distances) and distances.max() > apart:
        key = int(np.argmax(distances))
        chosen.append(key)
        distances = np.minimum(distances, np.hypot(*(poses[:, :2] - poses[key, :2]).T))
    return chosen


def _only(peaks: Sequence[Optional[Peak]]) -> Optional[Peak]:
    """The best peak, if no other that is elsewhere comes near to it."""
    found = sorted((peak for peak in peaks if peak is not None), key=lambda peak: -peak.score)
    for other in found[1:]:
        is_same = (
            other.base_pose.distance_to(found[0].base_pose) < _SAME_PLACE
            and abs(wrap(other.base_pose.yaw - found[0].base_pose.yaw)) < _SAME_HEADING
        )
        if not is_same and other.score > _RIVAL_SHARE * found[0].score:
            return None
    return found[0] if found else None
