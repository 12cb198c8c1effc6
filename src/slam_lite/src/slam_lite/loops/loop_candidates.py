"""Loop candidates: pairs of keyframes that may see the same place, where loop closures are searched.

A place is a candidate if the path to it along the pose graph, on which errors accumulate, is much longer than
the straight line (E. Olson, "Recognizing places using spectrally clustered local matches", RAS 2009). Outside
of the search windows of these, candidates come from place recognition.
"""

import math
from dataclasses import dataclass
from typing import List

import numpy as np

from planar import Pose2, wrap
from slam_lite.config import MapperSettings
from slam_lite.graph.drift import shortest_paths, variances_xy
from slam_lite.graph.pose_graph import Edges, relative_pose
from slam_lite.loops.place_recognition import PlaceHypothesis
from slam_lite.matching.correlative import SearchWindow

# Growth of the search window with the path along the graph: metres and radians per metre.
_DRIFT_DISTANCE, _DRIFT_ANGLE = 0.04, 0.008
# Size [m] of windows that are searched once per closure_interval; larger ones are searched less often.
_OFTEN_DISTANCE = 8.0
_MIN_WINDOW, _MAX_WINDOW = SearchWindow(0.3, 0.1), SearchWindow(12.0, 0.8)
# Path from which on the window does not grow any more [m].
_MAX_PATH = _MAX_WINDOW.distance / _DRIFT_DISTANCE
# Largest error of the graph in standard deviations, which are pessimistic.
_MAX_SIGMAS = 1.5
# Largest error of a pose from place recognition.
_RECOGNITION_WINDOW = SearchWindow(4.0, 0.15)
# Number of keyframes, and path [m] up to the recent one, that are merged for a match in windows up to
# _UNSCALED_DISTANCE [m]. In wider windows more are needed to distinguish corridors: in proportion to the
# size, at most _MAX_SCALE times as many.
_RECENT_KEYFRAMES, RECENT_PATH = 12, 4.0
_UNSCALED_DISTANCE, _MAX_SCALE = 2.0, 3.0
# Standard deviation, as a path length [m], from which on a step is a guess.
_GUESS_PATH = 5.0
_MAX_CANDIDATES = 3


@dataclass(frozen=True)
class LoopCandidate:
    """Two keyframes that may see the same place.

    Attributes:
        place: Index of the older keyframe.
        recent: Index of the recent keyframe.
        recent_keyframes: Number of keyframes up to the recent one that are merged for the match.
        window: Search window around ``guess``.
        scale: Factor by which more keyframes are merged than for a small window.
        guess: Estimated pose of the recent keyframe in the older one.
        is_recognized: Whether the guess comes from place recognition instead of the graph.
        alternatives: Number of places and headings, a search window each, that might have been recognized.
    """

    place: int
    recent: int
    recent_keyframes: int
    window: SearchWindow
    scale: float
    guess: Pose2
    is_recognized: bool = False
    alternatives: float = 1.0

    @property
    def is_ambiguous(self) -> bool:
        """Whether the robot may be at another place that looks similar."""
        return self.is_recognized or self.scale >= _MAX_SCALE


def loop_candidates(
    recent: int, poses: np.ndarray, edges: Edges, settings: MapperSettings
) -> List[LoopCandidate]:
    """Find the candidates that the graph suggests for a keyframe.

    Args:
        recent: Index of the keyframe.
        poses: (N, 3), poses of all keyframes in the map frame.
        edges: Edges of the pose graph.
        settings: ``closure_min_detour`` [m] and ``closure_interval`` [keyframes].

    Returns:
        At most three candidates, nearest first.
    """
    straight = np.hypot(poses[:, 0] - poses[recent, 0], poses[:, 1] - poses[recent, 1])
    if np.count_nonzero(straight < _MAX_WINDOW.distance + 2.0) <= _RECENT_KEYFRAMES:
        return []
    paths, _ = shortest_paths(recent, len(poses), edges, edge_lengths(edges), _MAX_PATH)
    windows = np.clip(_DRIFT_DISTANCE * paths, _MIN_WINDOW.distance, _MAX_WINDOW.distance)
    possible = (paths > settings.closure_min_detour + 2.0 * straight) & (straight < windows + 2.0)
    # A wide window is searched less often: it stays much the same while the robot drives on.
    intervals = np.maximum(1, np.rint(windows / _OFTEN_DISTANCE)) * settings.closure_interval
    possible &= recent % intervals < settings.closure_interval
    keyframes = np.flatnonzero(possible)
    if len(keyframes) == 0:
        return []
    segments = np.split(keyframes, np.flatnonzero(np.diff(keyframes) > 5) + 1)
    nearest = [int(segment[np.argmin(straight[segment])]) for segment in segments]
    nearest.sort(key=lambda place: straight[place])
    return [
        _candidate(place, recent, paths, float(windows[place]), relative_pose(poses, place, recent))
        for place in nearest[:_MAX_CANDIDATES]
    ]


def candidate_at_recognized_place(
    place: int, recent: int, recent_keyframes: int, recent_in_place: Pose2, alternatives: float
) -> LoopCandidate:
    """Create the candidate of a recognized place, independent of the graph.

    Args:
        place: Index of the older keyframe.
        recent: Index of the recent keyframe.
        recent_keyframes: Number of keyframes up to the recent one that are merged for the match.
        recent_in_place: Pose of the recent keyframe in the older one, from place recognition.
        alternatives: Number of places and headings that might have been recognized.
    """
    window = _RECOGNITION_WINDOW
    return LoopCandidate(
        place, recent, recent_keyframes, window, _MAX_SCALE, recent_in_place, True, alternatives
    )


def _candidate(place: int, recent: int, paths: np.ndarray, distance: float, guess: Pose2) -> LoopCandidate:
    scale = float(np.clip(distance / _UNSCALED_DISTANCE, 1.0, _MAX_SCALE))
    latest = paths[max(0, recent - round(scale * _RECENT_KEYFRAMES) + 1) : recent + 1][::-1]
    recent_keyframes = int(np.argmax(latest > scale * RECENT_PATH)) or len(latest)
    angle = float(np.clip(_DRIFT_ANGLE * paths[place], _MIN_WINDOW.angle, _MAX_WINDOW.angle))
    return LoopCandidate(place, recent, recent_keyframes, SearchWindow(distance, angle), scale, guess)


def are_outside_search_windows(paths: np.ndarray, drift: np.ndarray) -> np.ndarray:
    """Find the places that may lie outside of the windows that ``loop_candidates`` searches.

    Args:
        paths: (N,), length of the path along the graph to each place [m].
        drift: (N, 2), standard deviations of position [m] and heading [rad].

    Returns:
        (N,) booleans.
    """
    windows = np.clip(_DRIFT_DISTANCE * paths, _MIN_WINDOW.distance, _MAX_WINDOW.distance)
    return (_MAX_SIGMAS * drift[:, 0] > windows + 2.0) | (_MAX_SIGMAS * drift[:, 1] > _MAX_WINDOW.angle)


def is_within_drift(hypothesis: PlaceHypothesis, poses: np.ndarray, drift: np.ndarray) -> bool:
    """Check whether the drift of the graph can explain a place hypothesis.

    Args:
        hypothesis: Recognized place.
        poses: (N, 3), poses of all keyframes in the map frame.
        drift: (2,), standard deviations of position [m] and heading [rad] between the two keyframes.
    """
    measured = hypothesis.recent_in_place.inverse()
    estimated = relative_pose(poses, hypothesis.recent, hypothesis.place)
    is_near = measured.distance_to(estimated) < _MAX_SIGMAS * drift[0] + _RECOGNITION_WINDOW.distance
    turn = abs(wrap(measured.yaw - estimated.yaw))
    return bool(is_near and turn < _MAX_SIGMAS * drift[1] + _RECOGNITION_WINDOW.angle)


def count_alternatives(recent: int, places: np.ndarray, poses: np.ndarray, drift: np.ndarray) -> float:
    """Count the places, in search windows of their headings, at which a keyframe may be by the graph's drift.

    Args:
        recent: Index of the keyframe.
        places: (M,), indices of the places' keyframes.
        poses: (N, 3), poses of all keyframes in the map frame.
        drift: (M, 2), standard deviations of position [m] and heading [rad] from each place.
    """
    distances = np.hypot(*(poses[places, :2] - poses[recent, :2]).T)
    is_near = distances < _MAX_SIGMAS * drift[:, 0] + _RECOGNITION_WINDOW.distance
    headings = (
        np.clip(_MAX_SIGMAS * drift[:, 1], _RECOGNITION_WINDOW.angle, math.pi) / _RECOGNITION_WINDOW.angle
    )
    return float(headings[is_near].sum())


def edge_lengths(edges: Edges) -> np.ndarray:
    """Compute the length of each edge as a path on which errors accumulate.

    A step counts with its distance plus its rotation, one radian as one metre. A loop closure, or a step that
    is only a guess, counts as the path on which the front end drifts by its standard deviation.

    Args:
        edges: Edges of the graph, E.

    Returns:
        (E,) [m].
    """
    steps = edges.measured
    lengths = np.hypot(steps[:, 0], steps[:, 1]) + np.abs(steps[:, 2])
    equivalent = np.sqrt(variances_xy(edges)) / _DRIFT_DISTANCE
    return np.where(edges.is_loop | (equivalent > _GUESS_PATH), equivalent, lengths)
