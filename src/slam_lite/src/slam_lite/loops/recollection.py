"""Places that a long way looks like: in the end, what single looks suggest is counted.

One look at a place suggests many others, of which a building has its share from each of its sides. Along some
sixty metres of way only the right ones go on to say the same, look after look. Theirs are guesses, for the
ways to be laid over each other there.
"""

import math
from typing import List, Sequence

import numba
import numpy as np

from planar import Pose2, wrap
from slam_lite.graph.certainty import Certainty
from slam_lite.graph.pose_graph import Edge, Edges, between
from slam_lite.loops.place_recognition import Hypothesis, compounded, hypotheses, places_along
from slam_lite.loops.way import Way
from slam_lite.surface import Surface

# Another time is so many metres of way before; and what is nearer than this to a closure is known.
_LATER, _KNOWN = 60.0, 6.0
# Two poses that differ by no more are one place, metres and radians.
_MET_XY, _MET_YAW = 3.0, 0.15
# Metres of way to each side on which looks may say the same, and how far apart the places that they name.
_REACH, _PLACES_APART = 30.0, 55.0
# By how much they may differ: metres and radians, and the same a metre of way.
_ERROR, _TURN, _ERROR_RATE, _TURN_RATE = 0.8, 0.06, 0.02, 0.002
# So many looks say the same, and as many times more than whatever else is said about there.
_LOOKS, _AHEAD = 14, 1.5
# A hypothesis's own information, of 1 m and 0.05 rad; and how far off the graph may be: the chi-square of one
# in a thousand, with three degrees of freedom.
_OWN_INFORMATION, _CREDIBLE = np.diag([1.0, 1.0, 0.05**-2]), 16.3


def recollected(poses: np.ndarray, edges: Edges, surfaces: Sequence[Surface], way: Way) -> List[Hypothesis]:
    """Of each look at what no closure ties the best hypothesis, if long ways agree and the graph does not.

    ``poses``: (N, 3) of the settled graph.
    """
    heard = _heard(surfaces, way, edges.nodes[edges.is_loop, 1])
    nodes, told = heard[:, :2].astype(np.int64), heard[:, 2:5]
    counts = _agreeing(nodes, told, way.poses, way.metres)
    robots = compounded(poses[nodes[:, 0]], told)
    best: List[Hypothesis] = []
    for recent in np.unique(nodes[counts >= _LOOKS, 1]).tolist():
        numbers = np.flatnonzero(nodes[:, 1] == recent)
        first = numbers[np.argmax(counts[numbers])]
        others = numbers[_elsewhere(robots[numbers], robots[first])]
        if _AHEAD * counts[others].max(initial=0) <= counts[first]:
            place, likeness = int(nodes[first, 0]), float(heard[first, 5])
            best.append(Hypothesis(place, recent, Pose2.from_array(told[first]), likeness))
    return [each for each in best if _is_possible_news(each, poses, edges)]


def _heard(surfaces: Sequence[Surface], way: Way, tied: np.ndarray) -> np.ndarray:
    """What each stretch of the way looks like, of those driven long before; nothing near ``tied`` keys.

    Rows (N, 6): place and recent key, the latter's x, y and yaw in the former, likeness. As rows they take a
    tenth of the memory.
    """
    places = places_along(surfaces, way.poses, way.metres)
    rows = [np.empty((0, 6))]
    for place in places:
        if np.abs(way.metres[tied] - way.metres[place.key]).min(initial=np.inf) > _KNOWN:
            before = way.metres[place.key] - _LATER
            look = hypotheses(place, [each for each in places if way.metres[each.key] < before])
            told = [(one.place, one.recent, *one.recent_in_place.as_array(), one.likeness) for one in look]
            rows.append(np.array(told).reshape(-1, 6))
    return np.concatenate(rows)


def _elsewhere(robots: np.ndarray, robot: np.ndarray) -> np.ndarray:
    """Which of some poses (N, 3) are quite another than a pose (3,)."""
    away = np.hypot(*(robots[:, :2] - robot[:2]).T)
    return (away > _MET_XY) | (np.abs(wrap(robots[:, 2] - robot[2])) > _MET_YAW)


def _is_possible_news(hypothesis: Hypothesis, poses: np.ndarray, edges: Edges) -> bool:
    """Whether the graph says something else, and may be so much off by all that it knows.

    Houses that are alike go on to say the same, too, along any way.
    """
    place, recent = hypothesis.place, hypothesis.recent
    told = Edge(place, recent, hypothesis.recent_in_place, _OWN_INFORMATION)
    believed = between(poses, place, recent).as_array()
    if not _elsewhere(told.second_in_first.as_array()[None], believed)[0]:
        return False
    return not Certainty(poses, edges, recent).is_surprised_by(told, _CREDIBLE)


def _agreeing(nodes: np.ndarray, told: np.ndarray, poses: np.ndarray, metres: np.ndarray) -> np.ndarray:
    """In how many looks (N,) of each hypothesis's neighbourhood one says the same.

    ``nodes``: (N, 2) place and recent key, in the order of the latter; ``told``: (N, 3) recent in place.
    """
    robots = compounded(poses[nodes[:, 0]], told)
    return _counts(nodes[:, 1], metres[nodes], poses[nodes[:, 1]], robots)


@numba.njit(cache=True, nogil=True)
def _counts(recents, metres, followed, robots):
    """``followed``, ``robots``: (N, 3), recent keys on the way, and where hypotheses have them."""
    counts = np.zeros(len(recents), dtype=np.int64)
    start = 0
    for i in range(len(recents)):
        while metres[start, 1] < metres[i, 1] - _REACH:
            start += 1
        turn = robots[i, 2] - followed[i, 2]
        c, s = math.cos(turn), math.sin(turn)
        last = recents[i]
        for j in range(start, len(recents)):
            if metres[j, 1] > metres[i, 1] + _REACH:
                break
            at_place = abs(metres[j, 0] - metres[i, 0])
            if recents[j] == recents[i] or recents[j] == last or at_place > _PLACES_APART:
                continue
            dx, dy = followed[j, 0] - followed[i, 0], followed[j, 1] - followed[i, 1]
            error = math.hypot(
                robots[i, 0] + c * dx - s * dy - robots[j, 0], robots[i, 1] + s * dx + c * dy - robots[j, 1]
            )
            turned = turn - robots[j, 2] + followed[j, 2]
            turned = abs(math.atan2(math.sin(turned), math.cos(turned)))
            far = abs(metres[j, 1] - metres[i, 1]) + at_place
            if error < _ERROR + _ERROR_RATE * far and turned < _TURN + _TURN_RATE * far:
                counts[i] += 1
                last = recents[j]
    return counts
