"""Ways driven again: in the end, long stretches of them are laid over each other.

Where little is seen, and that from the other side, as on the way back through a yard of trees, the few scans
of a closure tell nothing. What some thirty metres of way have seen together does, in a coarse grid that does
not ask from which side: as it was followed from scan to scan, for what closures elsewhere have bent the graph
by lies evenly on many steps, whereas wheels slip on one.
"""

from typing import List, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np

from planar import Pose2
from slam_lite.graph.pose_graph import Edge, Edges, between
from slam_lite.loops.cycle import cycle_error
from slam_lite.loops.lasting import lasting
from slam_lite.loops.recollection import recollected
from slam_lite.loops.sight import Placed
from slam_lite.loops.way import Way, way_of
from slam_lite.matching.correlative import Window, scores, search_far
from slam_lite.matching.local_map import LocalMap
from slam_lite.surface import Surface, thinned

# A place is looked for every so many metres, so near by the graph and so far back on the way.
_EVERY, _NEAR, _LATER = 3.0, 5.0, 60.0
# Places farther apart than so many keys are two; one nearer than this to a closure, metres, is known.
_KEYS_APART, _KNOWN = 30, 6.0
# So many metres of way a tie tells where the robot is.
_SINCE = 40.0
# Metres of way to each side of the recent key, and of the place; of the former so many scans at most.
_RECENT_WAY, _PLACE_WAY = 14.0, 20.0
_MOST_SCANS = 60
_LEAST_POINTS, _MOST_POINTS = 200, 400
# What is searched, in turn, and for which score; fits nearer to each other than this, metres, are one.
_SEARCHES, _APART = ((Window(3.0, 0.15), 0.3), (Window(6.0, 0.3), 0.5)), 0.6
# Poses around the best one that are weighed, by how much of its score they lack.
_STEPS_XY, _STEPS_YAW = np.arange(-1.0, 1.05, 0.2), np.arange(-0.12, 0.125, 0.02)
_SOFTNESS = 0.1
# Standard deviations, metres and radians: more in all directions is no fit, more in one a slide, of which
# that much is to be expected; and what is left in doubt anyway.
_MOST_XY, _MOST_YAW, _SLIDE, _SLID = 0.35, 0.04, 0.4, 1.0
_OWN_XY, _OWN_YAW = 0.1, 0.008
# A vaguer fit ties nothing, but leads the search on, up to these.
_VAGUE_XY, _VAGUE_YAW = 0.45, 0.055
# Witnesses: how many, how far from it on the two ways, and by how much they may differ: metres and radians,
# and the same a metre of way.
_WITNESSES, _RECENT_APART, _PLACE_APART = 2, (2.0, 20.0), 25.0
_ERROR, _TURN, _ERROR_RATE, _TURN_RATE = 0.35, 0.05, 0.015, 0.001


def ways_back(
    poses: np.ndarray, edges: Edges, surfaces: Sequence[Surface], local_map: LocalMap
) -> List[Edge]:
    """Closures of a settled graph, ``poses`` (N, 3), where it has none; ``local_map`` is overwritten."""
    if len(poses) < 2:
        return []
    search = _Search(poses, edges, surfaces, local_map)
    found = search.found()
    return [edge for edge in found if sum(_agree(edge, other, search.way) for other in found) >= _WITNESSES]


class _Fit(NamedTuple):
    """A stretch laid over another one, and whether it is sharp enough to tie them."""

    edge: Edge
    is_sharp: bool


class _Search:
    """Goes along the way, there and back, and ties it to what lies beside it.

    Where that is, the last tie tells, and the way since; if there is none, what it looks like there along
    a long way, or the graph.
    """

    def __init__(self, poses: np.ndarray, edges: Edges, surfaces: Sequence[Surface], local_map: LocalMap):
        self.way = way_of(poses[0], edges)
        self._poses, self._surfaces, self._local_map = poses, surfaces, local_map
        self._ties = [edges[number] for number in np.flatnonzero(edges.is_loop)]
        self._closures = len(self._ties)
        self._tried: Set[Tuple[int, int]] = set()
        self._recollected = recollected(poses, edges, surfaces, self.way)

    def found(self) -> List[Edge]:
        """All that fit sharply, also those that nobody confirms."""
        sharp: List[Edge] = []
        looks = np.flatnonzero(np.diff(np.floor(self.way.metres / _EVERY), prepend=-1.0)).tolist()
        for recent in (*looks, *reversed(looks)):
            for place, guess in self._beside(recent):
                if (place, recent) not in self._tried:
                    self._tried.add((place, recent))
                    fit = _laid(place, recent, guess, self.way, self._surfaces, self._local_map)
                    self._ties += [] if fit is None else [fit.edge]
                    sharp += [fit.edge] if fit is not None and fit.is_sharp else []
        return sharp

    def _beside(self, recent: int) -> List[Tuple[int, Pose2]]:
        """Places where the robot has been before, and from each where it is now."""
        numbers, beside = self._latest_ties(recent), []
        for number in numbers:
            tie = self._ties[number]
            is_known = number < self._closures and self.way.apart(tie.second, recent) < _KNOWN
            place = None if is_known else self._place_by(tie, recent)
            beside += [] if place is None else [place]
        for key, guess in (*self._recalled(recent), *self._near(recent)):
            if all(self.way.apart(self._ties[number].first, key) > 2.0 * _SINCE for number in numbers):
                beside.append((key, guess))
        return beside

    def _recalled(self, recent: int) -> List[Tuple[int, Pose2]]:
        """The place that it looks like about here, if many looks agree."""
        return [
            (each.place, each.recent_in_place @ self.way.between(each.recent, recent))
            for each in self._recollected
            if self.way.apart(each.recent, recent) < 0.5 * _EVERY
        ]

    def _latest_ties(self, recent: int) -> List[int]:
        """Numbers of the ties nearest on the way, one for each stretch of places."""
        nodes = np.array([(tie.first, tie.second) for tie in self._ties], dtype=np.int64).reshape(-1, 2)
        since = np.abs(self.way.metres[nodes[:, 1]] - self.way.metres[recent])
        latest: List[int] = []
        for number in np.argsort(since, kind="stable")[: np.count_nonzero(since <= _SINCE)].tolist():
            others = (self._ties[other].first for other in latest)
            if all(self.way.apart(self._ties[number].first, other) > 2.0 * _SINCE for other in others):
                latest.append(number)
        return latest

    def _place_by(self, tie: Edge, recent: int) -> Optional[Tuple[int, Pose2]]:
        """The place nearest to the robot by a tie and the way since, and where the robot is from there."""
        start, end = self.way.around(tie.first, 2.0 * _SINCE)
        end = min(end, self._end_of_places(recent) - 1)
        if end < start:
            return None
        robot = Pose2.from_array(self.way.poses[tie.first]) @ tie.second_in_first
        robot = robot @ self.way.between(tie.second, recent)
        distances = np.hypot(*(self.way.poses[start : end + 1, :2] - [robot.x, robot.y]).T)
        place = start + int(np.argmin(distances))
        if distances.min() > _NEAR:
            return None
        return place, Pose2.from_array(self.way.poses[place]).inverse() @ robot

    def _near(self, recent: int) -> List[Tuple[int, Pose2]]:
        """Places near by as the graph has it."""
        distances = np.hypot(*(self._poses[: self._end_of_places(recent), :2] - self._poses[recent, :2]).T)
        near = np.flatnonzero(distances < _NEAR)
        stretches = np.split(near, np.flatnonzero(np.diff(near) > _KEYS_APART) + 1)
        keys = [int(stretch[np.argmin(distances[stretch])]) for stretch in stretches if len(stretch)]
        return [(key, between(self._poses, key, recent)) for key in keys]

    def _end_of_places(self, recent: int) -> int:
        """The first key that is too near on the way to be another time."""
        return int(np.searchsorted(self.way.metres, self.way.metres[recent] - _LATER))


def _laid(
    place: int,
    recent: int,
    guess: Pose2,
    way: Way,
    surfaces: Sequence[Surface],
    local_map: LocalMap,
) -> Optional[_Fit]:
    """The stretches around two keys laid over each other, if they fit in one way only."""
    first, last = way.around(recent, _RECENT_WAY)
    here = _placed(first, last, recent, way, surfaces)
    seen = lasting(here[:: max(1, len(here) // _MOST_SCANS)])
    if len(seen) < _LEAST_POINTS:
        return None
    start, end = way.around(place, _PLACE_WAY)
    local_map.clear(Pose2())
    for placed in _placed(start, min(end, first - 1), place, way, surfaces):
        local_map.add(*placed)
    coarse, sample = local_map.beyond or local_map, thinned(seen, _MOST_POINTS)
    for window, least_score in _SEARCHES:
        peak = search_far(sample, coarse, guess, window, least_score, apart=_APART)
        if peak is not None:
            break
    if peak is None or not peak.is_unique:
        return None
    mean, spread = _weighed(peak.base_pose, sample, coarse)
    if not _is_within(spread, _VAGUE_XY, _VAGUE_YAW):
        return None
    edge = Edge(place, recent, mean, _information(spread), is_loop=True)
    return _Fit(edge, _is_within(spread, _MOST_XY, _MOST_YAW))


def _weighed(peak: Pose2, surface: Surface, local_map: LocalMap) -> Tuple[Pose2, np.ndarray]:
    """Mean and covariance (3, 3) of the poses around a peak, by how well they fit.

    After E. Olson, "Real-time correlative scan matching", ICRA 2009.
    """
    poses = np.stack(np.meshgrid(_STEPS_XY, _STEPS_XY, _STEPS_YAW, indexing="ij"), -1).reshape(-1, 3)
    poses += peak.as_array()
    fits = scores(surface, local_map, [Pose2.from_array(pose) for pose in poses])
    weights = np.exp((fits / fits.max() - 1.0) / _SOFTNESS)
    mean = np.average(poses, axis=0, weights=weights)
    return Pose2.from_array(mean), np.cov(poses.T, aweights=weights, ddof=0)


def _is_within(spread: np.ndarray, xy: float, yaw: float) -> bool:
    """Whether a covariance (3, 3) is of a fit so sharp, in one direction at least."""
    return bool(np.linalg.eigvalsh(spread[:2, :2])[0] <= xy**2 and spread[2, 2] <= yaw**2)


def _information(spread: np.ndarray) -> np.ndarray:
    """The information (3, 3) of a fit, which may be a slide, and has errors that its spread does not tell."""
    covariance = spread + np.diag([_OWN_XY**2, _OWN_XY**2, _OWN_YAW**2])
    (_, most), axes = np.linalg.eigh(spread[:2, :2])
    if most > _SLIDE**2:
        covariance[:2, :2] += _SLID**2 * np.outer(axes[:, 1], axes[:, 1])
    return np.linalg.inv(covariance)


def _agree(one: Edge, other: Edge, way: Way) -> bool:
    """Whether two closures near each other tell the same story, but for what they slide along."""
    on_way, at_place = way.apart(one.second, other.second), way.apart(one.first, other.first)
    if not _RECENT_APART[0] < on_way < _RECENT_APART[1] or at_place > _PLACE_APART:
        return False
    error, turn = cycle_error(
        one,
        other,
        way.between(one.second, other.second),
        way.between(one.first, other.first),
        _slide(one),
        _slide(other),
    )
    far = on_way + at_place
    return error < _ERROR + _ERROR_RATE * far and turn < _TURN + _TURN_RATE * far


def _slide(edge: Edge) -> np.ndarray:
    """Unit vector (2,), along first's axes, in which an edge knows little, or zeros."""
    (_, most), axes = np.linalg.eigh(np.linalg.inv(edge.information)[:2, :2])
    return axes[:, 1] if most > _SLIDE**2 + 0.5 * _SLID**2 else np.zeros(2)


def _placed(first: int, last: int, origin: int, way: Way, surfaces: Sequence[Surface]) -> List[Placed]:
    """Scans of some keys, each with its pose seen from ``origin``."""
    return [(surfaces[key], way.between(origin, key)) for key in range(first, last + 1)]
