"""Place recognition: similar places, independent of where the graph puts them.

A place descriptor holds profiles of the walls along the place's two main directions: how much wall faces each
of the four directions at each distance. Two places are compared by shifting their profiles along each other,
for each quarter turn, which gives their similarity and their relative pose (A. Censi et al., "Scan matching
in the Hough domain", ICRA 2005; T. Roefer, "Using histogram correlation to create consistent laser scan
maps", IROS 2002). Profiles need no initial guess. They are compared as Fourier transforms, which is fast
enough to compare a place with all others. The results are hypotheses, at which a loop closure is searched.
"""

import math
from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

import numpy as np
from scipy.fft import irfft

from planar import Pose2, wrap
from planar.geometry.pose import cos_sin
from slam_lite.graph.pose_graph import relative_pose
from slam_lite.point_cloud import PointCloud, merge_clouds

# Bin width of a profile [m], and number of bins; the outer half stays empty, so that profiles can be shifted
# along each other as far as the inner half is wide.
_BIN, _BINS = 0.25, 256
_REACH = 0.25 * _BIN * _BINS
# Size [m] of the pieces in which walls are measured; each counts once, however often it was seen.
_PIECE = 0.1
# Cosine from which on a wall faces a direction; least number of pieces of a place, and least strength of its
# axes, 0 to 1.
_FACING_COSINE, _MIN_PIECES, _MIN_STRENGTH = 0.9, 60, 0.3
# Largest distance between the keyframes of two descriptors of the same place [m].
_MAX_SHIFT = 12.0
# Places compared in one batch, to limit memory.
_BATCH = 128
# Hypotheses of one query, and least similarity, 0 to 1.
_MAX_HYPOTHESES, _MIN_SIMILARITY = 40, 0.3
# Path on which one place is seen, and from one to the next [m]; and the number of last queries in which a
# hypothesis has to be found again.
_SEGMENT_LENGTH, _QUERY_DISTANCE, _QUERIES = 12.0, 3.0, 4
# Largest difference of two consistent hypotheses, metres and radians, and the front end's drift per metre of
# path between them.
_SAME_PLACE, _SAME_HEADING, _DRIFT = 1.5, 0.15, 0.03


@dataclass(frozen=True, eq=False)
class PlaceDescriptor:
    """Descriptor of the surroundings of a keyframe.

    Attributes:
        keyframe: Index of the keyframe.
        axis: Direction of the place's x axis in the keyframe [rad].
        spectra: (4, F) complex, Fourier transforms of the profiles of walls that face +x, -x, +y and -y. The
            two of an axis together are normalized to length 1.
    """

    keyframe: int
    axis: float
    spectra: np.ndarray


@dataclass(frozen=True)
class PlaceHypothesis:
    """Two keyframes that may see the same place.

    Attributes:
        place: Index of the older keyframe.
        recent: Index of the recent keyframe.
        recent_in_place: Pose of the recent keyframe in the older one.
        similarity: Similarity of the two places, 0 to 1.
    """

    place: int
    recent: int
    recent_in_place: Pose2
    similarity: float


@dataclass(frozen=True)
class TrajectorySegment:
    """Consecutive keyframes that see one place.

    Attributes:
        first: Index of the first keyframe.
        middle: Index of the keyframe in the middle, whose frame is the frame of the place.
        last: Index of the last keyframe.
    """

    first: int
    middle: int
    last: int

    def descriptor(self, clouds: Sequence[PointCloud], poses: np.ndarray) -> Optional[PlaceDescriptor]:
        """Compute the descriptor of the place.

        Args:
            clouds: Points of all keyframes, each in its base frame.
            poses: (N, 3), poses of all keyframes in the map frame.

        Returns:
            The descriptor, None if the place has no main directions.
        """
        keyframes = range(self.first, self.last + 1)
        merged = merge_clouds([(clouds[i], relative_pose(poses, self.middle, i)) for i in keyframes])
        return place_descriptor(self.middle, merged)


@dataclass(frozen=True, eq=False)
class PlaceDatabase:
    """Place descriptors of a map, and the state of the queries along the present trajectory.

    Attributes:
        descriptors: Descriptors of all places so far.
        queries: Hypotheses of each of the last queries.
        last: Last keyframe of the last query's segment.
        start: First keyframe of the present trajectory.
    """

    descriptors: Tuple[PlaceDescriptor, ...] = ()
    queries: Tuple[Tuple[PlaceHypothesis, ...], ...] = ()
    last: int = 0
    start: int = 0

    def next_segment(self, travelled: np.ndarray) -> Optional[TrajectorySegment]:
        """Return the segment to query next.

        Args:
            travelled: (N,), path length from the first keyframe to each [m].

        Returns:
            The segment, None if the robot has not driven far enough.
        """
        if self.start >= len(travelled):
            return None
        due = max(travelled[self.start] + _SEGMENT_LENGTH, travelled[self.last] + _QUERY_DISTANCE)
        end = int(np.searchsorted(travelled, due))
        if end == len(travelled):
            return None
        first, middle = (
            int(np.searchsorted(travelled, travelled[end] - share * _SEGMENT_LENGTH)) for share in (1.0, 0.5)
        )
        return TrajectorySegment(max(first, self.start), middle, end)

    def extended(
        self,
        segment: TrajectorySegment,
        descriptor: Optional[PlaceDescriptor],
        hypotheses: Sequence[PlaceHypothesis],
    ) -> "PlaceDatabase":
        """Return the database with one more place.

        Args:
            segment: Keyframes that see the place.
            descriptor: Descriptor of the place, None if it has none.
            hypotheses: Results of the query with this descriptor.
        """
        descriptors = self.descriptors if descriptor is None else (*self.descriptors, descriptor)
        queries = (*self.queries, tuple(hypotheses))[-_QUERIES:]
        return PlaceDatabase(descriptors, queries, segment.last, self.start)

    def with_new_trajectory(self, start: int) -> "PlaceDatabase":
        """Return the database for a new trajectory.

        Args:
            start: Index of the first keyframe of the trajectory.
        """
        return PlaceDatabase(self.descriptors, (), start, start)

    def confirmed(self, hypotheses: Sequence[PlaceHypothesis], poses: np.ndarray) -> List[PlaceHypothesis]:
        """Select the hypotheses of a query that are consistent with one of the last queries.

        Args:
            hypotheses: Hypotheses of the query.
            poses: (N, 3), poses of all keyframes in the map frame.
        """
        is_confirmed = np.zeros(len(hypotheses), dtype=bool)
        for earlier in self.queries:
            is_confirmed |= are_consistent(hypotheses, earlier, poses).any(axis=1)
        return [hypothesis for hypothesis, confirmed in zip(hypotheses, is_confirmed) if confirmed]


def database_of_map(clouds: Sequence[PointCloud], poses: np.ndarray) -> PlaceDatabase:
    """Compute the descriptors of all places of a finished map, for a new trajectory in it.

    Args:
        clouds: Points of all keyframes, each in its base frame.
        poses: (N, 3), poses of all keyframes in the map frame.
    """
    descriptors = descriptors_along(clouds, poses, travelled_distances(poses))
    return PlaceDatabase(descriptors, (), len(poses), len(poses))


def descriptors_along(
    clouds: Sequence[PointCloud], poses: np.ndarray, travelled: np.ndarray
) -> Tuple[PlaceDescriptor, ...]:
    """Compute the descriptors of all places along a trajectory, in order.

    Args:
        clouds: Points of all keyframes, each in its base frame.
        poses: (N, 3), poses of the keyframes in a common frame.
        travelled: (N,), path length from the first keyframe to each [m].
    """
    database = PlaceDatabase()
    segment = database.next_segment(travelled)
    while segment is not None:
        database = database.extended(segment, segment.descriptor(clouds, poses), ())
        segment = database.next_segment(travelled)
    return database.descriptors


def travelled_distances(poses: np.ndarray) -> np.ndarray:
    """Compute the path length from the first pose to each.

    Args:
        poses: (N, 3), rows ``[x, y, yaw]``.

    Returns:
        (N,) [m].
    """
    if len(poses) == 0:
        return np.empty(0)
    return np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(poses[:, :2], axis=0).T))))


def place_descriptor(keyframe: int, cloud: PointCloud) -> Optional[PlaceDescriptor]:
    """Compute the descriptor of the surroundings of a keyframe.

    Args:
        keyframe: Index of the keyframe.
        cloud: Points around the keyframe, in its frame.

    Returns:
        The descriptor, None if the points have no main directions.
    """
    pieces = np.floor(cloud.points_xy / _PIECE).astype(np.int64)
    _, kept = np.unique(pieces[:, 0] * 2**20 + pieces[:, 1], return_index=True)
    points, normals = cloud.points_xy[kept], cloud.normals_xy[kept]
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
    return PlaceDescriptor(keyframe, axis, spectra.astype(np.complex64))


def match_places(recent: PlaceDescriptor, places: Sequence[PlaceDescriptor]) -> List[PlaceHypothesis]:
    """Find the places that are similar to another one.

    Args:
        recent: Descriptor of the place to find.
        places: Descriptors to compare it with.

    Returns:
        Hypotheses, most similar first.
    """
    rotated = [recent.spectra]
    for _ in range(3):
        rotated.append(_quarter_turned(rotated[-1]))
    similarity = np.empty((4, len(places)), dtype=np.float32)
    best = np.empty((4, len(places), 2), dtype=np.int64)
    for start in range(0, len(places), _BATCH):
        block = slice(start, start + _BATCH)
        stacked = np.stack([place.spectra for place in places[block]])
        for quarters, spectra in enumerate(rotated):
            similarity[quarters, block], best[quarters, block] = _compare(stacked, spectra)
    found = [
        (similarity[quarters, i], quarters, i)
        for quarters in range(4)
        for i in np.argsort(-similarity[quarters])[:_MAX_HYPOTHESES]
        if similarity[quarters, i] > _MIN_SIMILARITY
    ]
    found.sort(key=lambda each: -each[0])
    return [
        _hypothesis(places[i], recent, quarters, _SHIFTS[best[quarters, i]] * _BIN, likeness)
        for likeness, quarters, i in found[:_MAX_HYPOTHESES]
    ]


def _compare(stacked: np.ndarray, spectra: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Compare a place with others.

    Args:
        stacked: (N, 4, F), spectra of the others.
        spectra: (4, F), spectra of the place.

    Returns:
        Similarities (N,), and the best of ``_SHIFTS`` along both directions (N, 2).
    """
    correlated = (stacked * spectra.conj()).reshape(len(stacked), 2, 2, -1).sum(axis=2)
    correlation = irfft(correlated, _BINS, axis=-1)[:, :, _SHIFTS]
    best = correlation.argmax(axis=2)
    return np.take_along_axis(correlation, best[:, :, None], axis=2)[:, :, 0].prod(axis=1), best


_SHIFTS = np.arange(-round(_MAX_SHIFT / _BIN), round(_MAX_SHIFT / _BIN) + 1)


def are_consistent(
    hypotheses: Sequence[PlaceHypothesis], others: Sequence[PlaceHypothesis], poses: np.ndarray
) -> np.ndarray:
    """Find the pairs of hypotheses of two queries that place the trajectory consistently.

    Args:
        hypotheses: Hypotheses of one query, N.
        others: Hypotheses of the other query, M.
        poses: (K, 3), poses of all keyframes in the map frame.

    Returns:
        (N, M) booleans.
    """
    if not hypotheses or not others:
        return np.zeros((len(hypotheses), len(others)), dtype=bool)
    step = relative_pose(poses, hypotheses[0].recent, others[0].recent)
    expected = compose_poses(_recent_in_map(hypotheses, poses), step.as_array()[None])
    difference = expected[:, None] - _recent_in_map(others, poses)[None]
    drift = _DRIFT * math.hypot(step.x, step.y)
    is_near = np.hypot(difference[..., 0], difference[..., 1]) < _SAME_PLACE + drift
    return is_near & (np.abs(wrap(difference[..., 2])) < _SAME_HEADING)


def _recent_in_map(hypotheses: Sequence[PlaceHypothesis], poses: np.ndarray) -> np.ndarray:
    """Pose (N, 3) of the recent keyframe in the map by each hypothesis of a query."""
    places = [hypothesis.place for hypothesis in hypotheses]
    return compose_poses(poses[places], np.array([each.recent_in_place.as_array() for each in hypotheses]))


def compose_poses(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Compose poses with relative poses, row by row.

    Args:
        first: (N, 3), poses in a common frame.
        second: (N, 3) or (1, 3), poses relative to ``first``.

    Returns:
        (N, 3), poses in the common frame.
    """
    c, s = cos_sin(first[:, 2])
    x = first[:, 0] + c * second[:, 0] - s * second[:, 1]
    y = first[:, 1] + s * second[:, 0] + c * second[:, 1]
    return np.column_stack((x, y, wrap(first[:, 2] + second[:, 2])))


def _profile(points: np.ndarray, normals: np.ndarray, along: int, sign: float) -> np.ndarray:
    """Square root (_BINS,) of how much wall faces one direction at each distance along that axis."""
    facing = (sign * normals[:, along] > _FACING_COSINE) & (np.abs(points) < _REACH).all(axis=1)
    bins = np.rint(points[facing, along] / _BIN).astype(np.int64) % _BINS
    counts = np.bincount(bins, minlength=_BINS).astype(np.float64)
    blurred = 0.5 * counts + 0.25 * (np.roll(counts, 1) + np.roll(counts, -1))
    return np.sqrt(blurred)


def _quarter_turned(spectra: np.ndarray) -> np.ndarray:
    """Spectra of a place rotated by 90 degrees: walls that faced +x face +y, those that faced +y face -x."""
    return np.stack((spectra[3].conj(), spectra[2].conj(), spectra[0], spectra[1]))


def _hypothesis(
    place: PlaceDescriptor, recent: PlaceDescriptor, quarters: int, shift, similarity: float
) -> PlaceHypothesis:
    turn = Pose2(float(shift[0]), float(shift[1]), 0.5 * math.pi * quarters)
    in_place = Pose2(0.0, 0.0, place.axis) @ turn @ Pose2(0.0, 0.0, -recent.axis)
    return PlaceHypothesis(place.keyframe, recent.keyframe, in_place, float(similarity))
