"""Loop closures: recognising a place seen before, and being slow to believe it.

Where to look follows from the graph: a place is a candidate if the way to it along the graph, on which errors
add up, is much longer than the straight way (E. Olson, "Recognizing places using spectrally clustered local
matches", RAS 2009). What a search finds must be a good match, the only good one in the window, and - unless
the graph already knew the place to within a small window - be confirmed by a second closure nearby that says
the same; by two more if the place was but recognised.
"""

import math
from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

import numpy as np

from planar import Pose2, wrap
from slam_lite.config import MapperSettings
from slam_lite.graph.drift import shortest_ways, variances_xy
from slam_lite.graph.pose_graph import Edge, Edges
from slam_lite.loops.cycle import cycle_error, turned
from slam_lite.loops.lasting import lasting
from slam_lite.loops.place_recognition import Hypothesis
from slam_lite.loops.sight import Placed, clash
from slam_lite.loops.sliding import PARALLEL, known_of, refined
from slam_lite.matching.correlative import Window, search_far
from slam_lite.matching.local_map import LocalMap, Match
from slam_lite.surface import Surface, thinned

# Growth of the search window with the way along the graph: metres and radians per metre.
_DRIFT_DISTANCE, _DRIFT_ANGLE = 0.04, 0.008
# The size of windows that are searched once an interval.
_OFTEN_DISTANCE = 8.0
_MIN_WINDOW, _MAX_WINDOW = Window(0.3, 0.1), Window(12.0, 0.8)
# From this way on the window does not grow any more, metres.
_FARTHEST = _MAX_WINDOW.distance / _DRIFT_DISTANCE
# By how many standard deviations the graph may be off; those that matches tell of themselves are cautious.
_CREDIBLE = 1.5
# Share of the walls that may be seen through where a place is doubtful, as by people who have gone on.
_MAX_CLASH = 0.025
# Two closures that differ by more than this, metres, put the robot to different places.
_ELSEWHERE = 3.0
# How far off the pose may be at which two places look alike.
_LIKENESS_WINDOW = Window(4.0, 0.15)
# Closures found in windows up to this size need no second witness.
_FAMILIAR_DISTANCE = 1.0
# Key scans of the place (to each side) and of the robot's recent way that are put together for a match,
# and out to which distance: in windows up to the given size; in wider ones in proportion, up to so many times
# as many, for there it takes more to tell one corridor from another.
_PLACE_KEYS, _RECENT_KEYS = 20, 12
_PLACE_RADIUS, _RECENT_WAY = 6.0, 4.0
_ENOUGH_FOR_DISTANCE, _MAX_SCALE = 2.0, 3.0
_GUESS_WAY = 5.0
# How far from each other two closures are made that share no scan and yet speak of the same stretch, metres.
_MAX_WITNESS_WAY = 15.0
# How long a place that was but recognised has to go on alike, metres: corridors' crossings are much the same.
_LONG_WAY = 11.0
_MAX_POINTS = 500
_MAX_CANDIDATES = 3


@dataclass(frozen=True)
class Candidate:
    """Key ``place``, perhaps near key ``recent``, seen from it in the ``window`` around ``guess``.

    ``recent_keys``: how many keys up to recent are put together. ``scale``: how much more is needed than in
    a small window. ``is_recognised``: the guess is not the graph's, but what the place looks like.
    """

    place: int
    recent: int
    recent_keys: int
    window: Window
    scale: float
    guess: Pose2
    is_recognised: bool = False

    @property
    def is_doubtful(self) -> bool:
        """Whether the robot may as well be somewhere else that looks much the same."""
        return self.is_recognised or self.scale >= _MAX_SCALE


@dataclass(frozen=True, eq=False)
class Closure:
    """An edge from a place seen before to a recent key, and the candidate that it was found at.

    ``slide``: unit vector (2,), along first's axes, in which the edge knows nothing, or zeros.
    ``is_surprising``: whether the graph believed something else.
    """

    edge: Edge
    candidate: Candidate
    slide: np.ndarray
    is_surprising: bool = False

    @property
    def witnesses_needed(self) -> int:
        """How many others have to say the same; none if the graph knew the place well beforehand."""
        if self.candidate.is_recognised:
            return 2
        return 0 if self.candidate.window.distance <= _FAMILIAR_DISTANCE and not self.is_surprising else 1


def candidates(recent: int, poses: np.ndarray, edges: Edges, settings: MapperSettings) -> List[Candidate]:
    """Places worth searching for key ``recent``, most likely first; ``poses`` (N, 3) of all keys."""
    straight = np.hypot(poses[:, 0] - poses[recent, 0], poses[:, 1] - poses[recent, 1])
    if np.count_nonzero(straight < _MAX_WINDOW.distance + 2.0) <= _RECENT_KEYS:
        return []
    detours, _ = shortest_ways(recent, len(poses), edges, lengths_of(edges), _FARTHEST)
    windows = np.clip(_DRIFT_DISTANCE * detours, _MIN_WINDOW.distance, _MAX_WINDOW.distance)
    possible = (detours > settings.closure_min_detour + 2.0 * straight) & (straight < windows + 2.0)
    # A wide window is searched more seldom: it stays much the same while the robot goes on.
    intervals = np.maximum(1, np.rint(windows / _OFTEN_DISTANCE)) * settings.closure_interval
    possible &= recent % intervals < settings.closure_interval
    keys = np.flatnonzero(possible)
    if len(keys) == 0:
        return []
    stretches = np.split(keys, np.flatnonzero(np.diff(keys) > 5) + 1)
    nearest = [int(stretch[np.argmin(straight[stretch])]) for stretch in stretches]
    nearest.sort(key=lambda key: straight[key])
    return [
        _candidate(key, recent, detours, float(windows[key]), _between(poses[key], poses[recent]))
        for key in nearest[:_MAX_CANDIDATES]
    ]


def recognised(place: int, recent: int, recent_keys: int, recent_in_place: Pose2) -> Candidate:
    """The candidate at a place that looks like where ``recent`` is, whatever the graph says."""
    return Candidate(place, recent, recent_keys, _LIKENESS_WINDOW, _MAX_SCALE, recent_in_place, True)


def _candidate(place: int, recent: int, detours: np.ndarray, distance: float, guess: Pose2) -> Candidate:
    scale = float(np.clip(distance / _ENOUGH_FOR_DISTANCE, 1.0, _MAX_SCALE))
    latest = detours[max(0, recent - round(scale * _RECENT_KEYS) + 1) : recent + 1][::-1]
    recent_keys = int(np.argmax(latest > scale * _RECENT_WAY)) or len(latest)
    angle = float(np.clip(_DRIFT_ANGLE * detours[place], _MIN_WINDOW.angle, _MAX_WINDOW.angle))
    return Candidate(place, recent, recent_keys, Window(distance, angle), scale, guess)


def find_closure(
    candidate: Candidate,
    poses: np.ndarray,
    surfaces: Sequence[Surface],
    local_map: LocalMap,
    settings: MapperSettings,
) -> Optional[Closure]:
    """The closure at a candidate, if a good and unambiguous match is there. ``local_map`` is overwritten."""
    place, recent = candidate.place, candidate.recent
    first_recent = recent - candidate.recent_keys + 1
    there = _around(place, candidate.scale, first_recent, poses, surfaces)
    local_map.clear(Pose2())
    for placed in there:
        local_map.add(*placed)
    here = [(surfaces[key], _between(poses[recent], poses[key])) for key in range(first_recent, recent + 1)]
    recent_surface = thinned(lasting(here), _MAX_POINTS)
    if len(recent_surface) < 50:
        return None
    min_score = 0.7 * settings.closure_min_response
    sample, searched = thinned(recent_surface, 200), local_map.fit_for(recent_surface)
    peak = search_far(sample, searched, candidate.guess, candidate.window, min_score, apart=0.6)
    if peak is None or not peak.is_unique or (candidate.is_recognised and peak.slide.any()):
        return None

    def fit(start: Pose2) -> Optional[Match]:
        match = refined(recent_surface, local_map, start, settings.closure_min_response)
        if match is None or not candidate.is_doubtful:
            return match
        return match if clash(there, here, match.base_pose) <= _MAX_CLASH else None

    known = known_of(peak, candidate.guess, recent_surface, local_map, fit)
    if known is None:
        return None
    edge = Edge(place, recent, known.base_in_place, known.information, is_loop=True)
    return Closure(edge, candidate, known.slide)


def _around(
    place: int, scale: float, end: int, poses: np.ndarray, surfaces: Sequence[Surface]
) -> List[Placed]:
    """The scans near a place on the way through it, before key ``end``, each with its pose seen from it."""
    reach = round(scale * _PLACE_KEYS)
    keys = range(max(0, place - reach), min(end, place + reach + 1))
    seen = [(surfaces[key], _between(poses[place], poses[key])) for key in keys]
    return [(surface, pose) for surface, pose in seen if math.hypot(pose.x, pose.y) < scale * _PLACE_RADIUS]


def are_out_of_reach(ways: np.ndarray, drift: np.ndarray) -> np.ndarray:
    """Which places (N,), so many metres along the graph, may lie elsewhere than ``candidates`` looks for.

    ``drift``: standard deviations (N, 2) of position and heading.
    """
    windows = np.clip(_DRIFT_DISTANCE * ways, _MIN_WINDOW.distance, _MAX_WINDOW.distance)
    return (_CREDIBLE * drift[:, 0] > windows + 2.0) | (_CREDIBLE * drift[:, 1] > _MAX_WINDOW.angle)


def is_credible(hypothesis: Hypothesis, poses: np.ndarray, drift: np.ndarray) -> bool:
    """Whether the graph may be so much off as a hypothesis says; ``drift`` (2,) as above."""
    told = hypothesis.recent_in_place.inverse()
    believed = _between(poses[hypothesis.recent], poses[hypothesis.place])
    near = told.distance_to(believed) < _CREDIBLE * drift[0] + _LIKENESS_WINDOW.distance
    return bool(near and abs(wrap(told.yaw - believed.yaw)) < _CREDIBLE * drift[1] + _LIKENESS_WINDOW.angle)


def agree(one: Closure, other: Closure, poses: np.ndarray) -> bool:
    """Whether two closures between the same two stretches of the way tell the same story.

    Around the cycle place - recent - other recent - other place - place the errors must cancel, up to what
    the front end may have drifted between them, and across a corridor that both may slide along. One that
    slides is no witness for one that does not: it cannot tell how far along the robot is.
    """
    recent_way, place_way, error, turn = _disagreement(one, other, poses)
    if not _RECENT_WAY <= recent_way <= _MAX_WITNESS_WAY:
        return False
    if one.slide.any() != other.slide.any():
        return False
    if one.slide.any() and abs(one.slide @ _slide_of(other, one, poses)) < PARALLEL:
        return False
    way = recent_way + place_way
    return error < 0.15 + 0.02 * way and turn < 0.05 + 0.005 * way


def is_confirmed(closure: Closure, witnesses: Sequence[Closure], poses: np.ndarray) -> bool:
    """Whether enough others that agree say the same; of a place that was but recognised, also from far on."""
    if len(witnesses) < closure.witnesses_needed:
        return False
    ways = [_disagreement(closure, other, poses)[0] for other in witnesses]
    return not closure.candidate.is_recognised or max(ways) >= _LONG_WAY


def contradict(one: Closure, other: Closure, poses: np.ndarray) -> bool:
    """Whether two closures of the same stretch of the way put it to different places."""
    recent_way, place_way, error, turn = _disagreement(one, other, poses)
    if recent_way > _MAX_WITNESS_WAY:
        return False
    way = recent_way + place_way
    return error > _ELSEWHERE + 0.1 * way or turn > 0.3


def _disagreement(one: Closure, other: Closure, poses: np.ndarray) -> Tuple[float, float, float, float]:
    """How far the recent keys and the places of two closures lie apart, and the error around their cycle.

    Along a corridor in which one of them slides, there is none.
    """
    a, b = one.edge, other.edge
    recent_step = _between(poses[a.second], poses[b.second])
    place_step = _between(poses[a.first], poses[b.first])
    error, turn = cycle_error(a, b, recent_step, place_step, one.slide, other.slide)
    recent_way, place_way = (math.hypot(step.x, step.y) for step in (recent_step, place_step))
    return recent_way, place_way, error, turn


def _slide_of(closure: Closure, seen_from: Closure, poses: np.ndarray) -> np.ndarray:
    """The slide of a closure along the axes of another one's place, (2,)."""
    place_step = _between(poses[seen_from.edge.first], poses[closure.edge.first])
    return turned(closure.slide, place_step.yaw)


def lengths_of(edges: Edges) -> np.ndarray:
    """How long each edge is, (E,): metres, with a radian counted as one.

    A closure, and a step that is but a guess, is as long as the way on which the front end would err as much.
    """
    steps = edges.measured
    lengths = np.hypot(steps[:, 0], steps[:, 1]) + np.abs(steps[:, 2])
    doubts = np.sqrt(variances_xy(edges)) / _DRIFT_DISTANCE
    return np.where(edges.is_loop | (doubts > _GUESS_WAY), doubts, lengths)


def _between(first: np.ndarray, second: np.ndarray) -> Pose2:
    return Pose2.from_array(first).inverse() @ Pose2.from_array(second)
