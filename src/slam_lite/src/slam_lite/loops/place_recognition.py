"""Recognising places by what they look like, wherever the graph believes them to be.

The surroundings of a place are told by profiles along their own two main directions: how much wall faces each
of the four ways at each distance. Two places are compared by sliding their profiles along each other, for
each quarter turn, which tells how alike they are and where one lies in the other (A. Censi et al., "Scan
matching in the Hough domain", ICRA 2005; T. Roefer, "Using histogram correlation to create consistent laser
scan maps", IROS 2002). Profiles need no guess, and are compared so fast, as Fourier transforms, that a place
is compared with all others. What looks alike is but a hypothesis, for a closure to be searched there.
"""

import math
from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

import numpy as np
from scipy.fft import irfft

from planar import Pose2, wrap
from slam_lite.graph.pose_graph import between
from slam_lite.surface import Surface, joined

# Width of a profile's bins, metres, and how many there are; the outer half stays empty, so that profiles can
# be slid along each other as far as the inner half is wide.
_BIN, _BINS = 0.25, 256
_REACH = 0.25 * _BIN * _BINS
# Walls are measured in pieces of this size, metres, however often they were seen.
_PIECE = 0.1
# A wall counts for a direction from this cosine on; how many pieces a place needs, and how much its axes
# stand out, 0 to 1.
_ALONG, _MIN_PIECES, _MIN_STRENGTH = 0.9, 60, 0.3
# How far apart two places may be and still be told from each other's surroundings, metres.
_MAX_SHIFT = 12.0
# Places compared in one go, for the memory that it takes.
_AT_ONCE = 128
# Hypotheses taken from one comparison, and how alike the places must be at least, 0 to 1.
_MAX_HYPOTHESES, _MIN_LIKENESS = 40, 0.3
# The way of the robot on which it sees one place, and from one to the next, metres; and in how many of the
# last looks a hypothesis is to be found again.
_PLACE_WAY, _LOOK_WAY, _LOOKS = 12.0, 3.0, 4
# Two hypotheses say the same if they differ by no more than this, in metres and radians, and by what the
# front end may have drifted on the way between them.
_SAME_PLACE, _SAME_HEADING, _DRIFT = 1.5, 0.15, 0.03


@dataclass(frozen=True, eq=False)
class Appearance:
    """What the surroundings of key scan ``key`` look like.

    ``axis``: direction, radians in the key's frame, of the x axis of ``spectra``: (4, F) complex, the Fourier
    transforms of the profiles of walls that face +x, -x, +y and -y. Those of both directions have length 1.
    """

    key: int
    axis: float
    spectra: np.ndarray


@dataclass(frozen=True)
class Hypothesis:
    """Key ``recent`` perhaps lies at ``recent_in_place`` of key ``place``; ``likeness``: 0 to 1."""

    place: int
    recent: int
    recent_in_place: Pose2
    likeness: float


@dataclass(frozen=True)
class Stretch:
    """The key scans of a stretch of the way, from ``first`` to ``last``, with ``middle`` in its middle."""

    first: int
    middle: int
    last: int

    def appearance(self, surfaces: Sequence[Surface], poses: np.ndarray) -> Optional[Appearance]:
        """What it looks like there, if that can be told."""
        origin = _pose(poses, self.middle).inverse()
        keys = range(self.first, self.last + 1)
        return appearance_of(
            self.middle, joined([(surfaces[key], origin @ _pose(poses, key)) for key in keys])
        )


@dataclass(frozen=True, eq=False)
class Memory:
    """What is remembered of ``places`` seen so far, and the hypotheses of the last ``looks``.

    ``last``: the key at the last look's end; ``start``: the key at which the robot's present way began.
    """

    places: Tuple[Appearance, ...] = ()
    looks: Tuple[Tuple[Hypothesis, ...], ...] = ()
    last: int = 0
    start: int = 0

    def next_stretch(self, ways: np.ndarray) -> Optional[Stretch]:
        """The stretch to look at next, if there is one; ``ways`` (N,): from the first key to each, metres."""
        if self.start >= len(ways):
            return None
        reached = int(np.searchsorted(ways, max(ways[self.start] + _PLACE_WAY, ways[self.last] + _LOOK_WAY)))
        if reached == len(ways):
            return None
        first, middle = (
            int(np.searchsorted(ways, ways[reached] - share * _PLACE_WAY)) for share in (1.0, 0.5)
        )
        return Stretch(max(first, self.start), middle, reached)

    def after(self, stretch: Stretch, place: Optional[Appearance], look: Sequence[Hypothesis]) -> "Memory":
        """The memory with one more place and look."""
        places = self.places if place is None else (*self.places, place)
        return Memory(places, (*self.looks, tuple(look))[-_LOOKS:], stretch.last, self.start)

    def anew(self, key: int) -> "Memory":
        """The memory of a robot whose present way begins at ``key``."""
        return Memory(self.places, (), key, key)

    def confirmed(self, look: Sequence[Hypothesis], poses: np.ndarray) -> List[Hypothesis]:
        """Those of a look's hypotheses that one of the last looks said, too."""
        seen = np.zeros(len(look), dtype=bool)
        for earlier in self.looks:
            seen |= say_the_same(look, earlier, poses).any(axis=1)
        return [hypothesis for hypothesis, is_seen in zip(look, seen) if is_seen]


def remembered(surfaces: Sequence[Surface], poses: np.ndarray) -> Memory:
    """The memory of a finished map, before the robot goes on in it."""
    return Memory(places_along(surfaces, poses, ways_along(poses)), (), len(poses), len(poses))


def places_along(surfaces: Sequence[Surface], poses: np.ndarray, ways: np.ndarray) -> Tuple[Appearance, ...]:
    """What the stretches of a way look like, in their order; ``ways`` (N,): as above."""
    memory = Memory()
    stretch = memory.next_stretch(ways)
    while stretch is not None:
        memory = memory.after(stretch, stretch.appearance(surfaces, poses), ())
        stretch = memory.next_stretch(ways)
    return memory.places


def ways_along(poses: np.ndarray) -> np.ndarray:
    """The way (N,) that the robot has gone at each of its poses (N, 3), metres."""
    if len(poses) == 0:
        return np.empty(0)
    return np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(poses[:, :2], axis=0).T))))


def appearance_of(key: int, surface: Surface) -> Optional[Appearance]:
    """The appearance of what was seen around a key, in its frame; None if nothing has a direction there."""
    pieces = np.floor(surface.points_xy / _PIECE).astype(np.int64)
    _, kept = np.unique(pieces[:, 0] * 2**20 + pieces[:, 1], return_index=True)
    points, normals = surface.points_xy[kept], surface.normals_xy[kept]
    flat = normals.any(axis=1)
    if np.count_nonzero(flat) < _MIN_PIECES:
        return None
    quadrupled = np.exp(4j * np.arctan2(normals[flat, 1], normals[flat, 0])).mean()
    if abs(quadrupled) < _MIN_STRENGTH:
        return None
    axis = float(np.angle(quadrupled)) / 4.0
    turn = Pose2(0.0, 0.0, -axis)
    points, normals = turn.transform_points(points[flat]), turn.transform_points(normals[flat])
    profiles = np.array([_profile(points, normals, along, sign) for along in (0, 1) for sign in (1.0, -1.0)])
    pairs = profiles.reshape(2, 2, _BINS)
    lengths = np.sqrt((pairs**2).sum(axis=(1, 2), keepdims=True))
    spectra = np.fft.rfft(pairs / np.maximum(lengths, 1e-9), axis=-1).reshape(4, -1)
    return Appearance(key, axis, spectra.astype(np.complex64))


def hypotheses(recent: Appearance, places: Sequence[Appearance]) -> List[Hypothesis]:
    """Where ``recent`` may lie among other places, most likely first."""
    turns = [recent.spectra]
    for _ in range(3):
        turns.append(_quarter_turned(turns[-1]))
    alike = np.empty((4, len(places)), dtype=np.float32)
    best = np.empty((4, len(places), 2), dtype=np.int64)
    for start in range(0, len(places), _AT_ONCE):
        block = slice(start, start + _AT_ONCE)
        stacked = np.stack([place.spectra for place in places[block]])
        for quarters, turned in enumerate(turns):
            alike[quarters, block], best[quarters, block] = _compared(stacked, turned)
    found = [
        _hypothesis(places[i], recent, quarters, _SHIFTS[best[quarters, i]] * _BIN, alike[quarters, i])
        for quarters in range(4)
        for i in np.argsort(-alike[quarters])[:_MAX_HYPOTHESES]
        if alike[quarters, i] > _MIN_LIKENESS
    ]
    return sorted(found, key=lambda hypothesis: -hypothesis.likeness)[:_MAX_HYPOTHESES]


def _compared(stacked: np.ndarray, turned: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """How alike to a place some others are, (N,), and at which of ``_SHIFTS`` along both directions, (N, 2).

    ``stacked``: spectra (N, 4, F) of the others; ``turned``: (4, F).
    """
    correlated = (stacked * turned.conj()).reshape(len(stacked), 2, 2, -1).sum(axis=2)
    likeness = irfft(correlated, _BINS, axis=-1)[:, :, _SHIFTS]
    best = likeness.argmax(axis=2)
    return np.take_along_axis(likeness, best[:, :, None], axis=2)[:, :, 0].prod(axis=1), best


_SHIFTS = np.arange(-round(_MAX_SHIFT / _BIN), round(_MAX_SHIFT / _BIN) + 1)


def say_the_same(look: Sequence[Hypothesis], other: Sequence[Hypothesis], poses: np.ndarray) -> np.ndarray:
    """Which hypotheses of two looks place the way alike: (N, M) booleans; ``poses`` (K, 3) of the keys."""
    if not look or not other:
        return np.zeros((len(look), len(other)), dtype=bool)
    step = between(poses, look[0].recent, other[0].recent)
    told, retold = compounded(_told(look, poses), step.as_array()[None]), _told(other, poses)
    way = math.hypot(step.x, step.y)
    away = told[:, None] - retold[None]
    near = np.hypot(away[..., 0], away[..., 1]) < _SAME_PLACE + _DRIFT * way
    return near & (np.abs(wrap(away[..., 2])) < _SAME_HEADING)


def _told(look: Sequence[Hypothesis], poses: np.ndarray) -> np.ndarray:
    """Where each hypothesis of a look (N, 3) puts the recent key."""
    places = [hypothesis.place for hypothesis in look]
    return compounded(poses[places], np.array([each.recent_in_place.as_array() for each in look]))


def compounded(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Poses (N, 3) that are seen from the ``first`` ones (N, 3) at the ``second`` (N, 3), or (1, 3)."""
    c, s = np.cos(first[:, 2]), np.sin(first[:, 2])
    x = first[:, 0] + c * second[:, 0] - s * second[:, 1]
    y = first[:, 1] + s * second[:, 0] + c * second[:, 1]
    return np.column_stack((x, y, wrap(first[:, 2] + second[:, 2])))


def _profile(points: np.ndarray, normals: np.ndarray, along: int, sign: float) -> np.ndarray:
    """How much wall (_BINS,) faces one way at each distance along that axis, as a square root."""
    facing = (sign * normals[:, along] > _ALONG) & (np.abs(points) < _REACH).all(axis=1)
    bins = np.rint(points[facing, along] / _BIN).astype(np.int64) % _BINS
    counts = np.bincount(bins, minlength=_BINS).astype(np.float64)
    blurred = 0.5 * counts + 0.25 * (np.roll(counts, 1) + np.roll(counts, -1))
    return np.sqrt(blurred)


def _quarter_turned(spectra: np.ndarray) -> np.ndarray:
    """The spectra of surroundings turned by 90 degrees: what faced +x faces +y, what faced +y faces -x."""
    return np.stack((spectra[3].conj(), spectra[2].conj(), spectra[0], spectra[1]))


def _hypothesis(place: Appearance, recent: Appearance, quarters: int, shift, alike: float) -> Hypothesis:
    turn = Pose2(float(shift[0]), float(shift[1]), 0.5 * math.pi * quarters)
    in_place = Pose2(0.0, 0.0, place.axis) @ turn @ Pose2(0.0, 0.0, -recent.axis)
    return Hypothesis(place.key, recent.key, in_place, float(alike))


def _pose(poses: np.ndarray, key: int) -> Pose2:
    return Pose2.from_array(poses[key])
