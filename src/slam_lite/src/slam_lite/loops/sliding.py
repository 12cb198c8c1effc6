"""What a match knows where it can slide: along a smooth corridor it fits anywhere.

There it tells the way across and the heading, and nothing of the way along. So the direction has to be exact,
or else what is unknown along the corridor turns into an error across it; and of all the poses that fit, the
one is taken at which the robot was believed to be, for there such an error is least.
"""

import math
from dataclasses import dataclass
from typing import Callable, Optional

import numpy as np

from planar import Pose2
from slam_lite.matching.correlative import Peak, scores
from slam_lite.matching.local_map import LocalMap, Match
from slam_lite.matching.refinement import refine
from slam_lite.surface import Surface

# A match may slide by these ways, metres, if the score there is this share of its own.
_SLIDES = np.concatenate((-np.arange(0.2, 1.05, 0.1), np.arange(0.2, 1.05, 0.1)))
_SLIDE_SHARE = 0.9
# Who can slide as far as this, metres, can slide on.
_FAR = 0.95
# Standard deviation of what nothing is known of, metres.
_UNKNOWN = 1e3
# Cosine of the angle up to which two slides are along the same corridor.
PARALLEL = 0.95
# How far a match may be from the cell that led to it, metres and radians.
_MOST_MOVED, _MOST_TURNED = 0.3, 0.1


@dataclass(frozen=True, eq=False)
class Known:
    """Where a match puts the base in the place's frame, and how surely: ``information`` (3, 3).

    ``slide``: unit vector (2,) along which nothing is known, or zeros.
    """

    base_in_place: Pose2
    information: np.ndarray
    slide: np.ndarray


def refined(surface: Surface, local_map: LocalMap, start: Pose2, min_response: float) -> Optional[Match]:
    """The match beside ``start``, if it is a good one."""
    match = refine(surface, local_map, start, start, np.zeros((3, 3)))
    moved = start.inverse() @ match.base_pose
    is_near = math.hypot(moved.x, moved.y) <= _MOST_MOVED and abs(moved.yaw) <= _MOST_TURNED
    return match if is_near and match.response >= min_response else None


def known_of(
    peak: Peak,
    guess: Pose2,
    surface: Surface,
    local_map: LocalMap,
    fit: Callable[[Pose2], Optional[Match]],
) -> Optional[Known]:
    """What the match at a peak tells, None if it does not fit or fits as well elsewhere.

    ``guess``: where the base was believed to be; ``fit``: the match beside a pose, if it is good enough.
    """
    match = fit(peak.base_pose)
    if match is None:
        return None
    _, directions = np.linalg.eigh(match.information[:2, :2])
    weakest = directions[:, 0]
    if peak.slide.any() and abs(peak.slide @ weakest) < PARALLEL:
        return None
    way = math.inf if peak.slide.any() else _way_open(match, weakest, surface, local_map)
    if way < _FAR:
        return Known(match.base_pose, _blurred(match.information, way * weakest), np.zeros(2))
    match = fit(_nearest_on_line(match.base_pose, weakest, guess)) or match
    return Known(match.base_pose, _blurred(match.information, _UNKNOWN * weakest), weakest)


def _way_open(match: Match, direction: np.ndarray, surface: Surface, local_map: LocalMap) -> float:
    """How far a match could as well lie along a direction, metres, as far as ``_SLIDES`` goes.

    Along a smooth wall, a few points of noise hold a match in place, and its information takes them for
    features; so do the corners of a wall of which one side was seen before, and the other one is seen now.
    """
    pose = match.base_pose
    slid = [Pose2(pose.x + way * direction[0], pose.y + way * direction[1], pose.yaw) for way in _SLIDES]
    fits = scores(surface, local_map, [pose, *slid], is_sided=True)
    return float(np.abs(_SLIDES[fits[1:] >= _SLIDE_SHARE * fits[0]]).max(initial=0.0))


def _nearest_on_line(pose: Pose2, direction: np.ndarray, guess: Pose2) -> Pose2:
    """The pose, slid along a direction to where it is nearest to the guess."""
    way = direction @ [guess.x - pose.x, guess.y - pose.y]
    return Pose2(pose.x + way * direction[0], pose.y + way * direction[1], pose.yaw)


def _blurred(information: np.ndarray, sigma_xy: np.ndarray) -> np.ndarray:
    """The information (3, 3) less what an error of ``sigma_xy`` (2,), metres, in that direction takes."""
    sigma = np.append(sigma_xy, 0.0)
    taken = information @ sigma
    return information - np.outer(taken, taken) / (1.0 + sigma @ taken)
