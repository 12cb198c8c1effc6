"""Segments of a laser scan: groups of neighbouring points that are narrow enough for a person."""

import math
from typing import List, NamedTuple, Tuple

import numba
import numpy as np

from move_base_lite.costmap import Observation
from planar import Pose2

# Gap between the points of two segments, and the widest segment: a person, a cart, another robot [m].
SEGMENT_GAP, MAX_SEGMENT_WIDTH = 0.25, 1.5
MIN_SEGMENT_BEAMS = 3
FITTING_STEPS = 3
# Depth behind the convex hull of neighbouring points at which a segment is split [m].
MIN_CONCAVITY = 0.15
# Distance by which a beam must have passed a point for that to count as free [m].
FREE_MARGIN = 0.12
# Sectors of the free range around the sensor.
DIRECTIONS = 180
# Angle to the next point beyond a segment's end below which that point can occlude the object [rad].
OCCLUSION_ANGLE = 0.03
# Angle without beams above which a scan is no full circle [rad].
FULL_CIRCLE_GAP = 0.1
# Of a round object: least sine of half the angle it subtends, and least share of a circle's depth.
MIN_SINE, MIN_ROUNDNESS = 0.2, 0.5


class ScanSnapshot:
    """A scan in the odom frame.

    Attributes:
        sensor_in_odom: Pose of the sensor.
        stamp: Time of the scan [s].
        segments: Segments of the scan.
        beams: (N,) indices of the beams that end within the range, by angle.
        points_xy: (N, 2) ends of these beams, in the odom frame [m].
        edges: Whether the first and the last point are at the edges of the field of view, beyond which an
            object may continue.
    """

    def __init__(self, sensor_in_odom: Pose2, observation: Observation, max_range: float):
        """Project the scan into the odom frame and segment it.

        Args:
            sensor_in_odom: Pose of the sensor at the scan.
            observation: The scan.
            max_range: Range within which beams are used [m].
        """
        self.sensor_in_odom, self.stamp = sensor_in_odom, observation.stamp
        self.segments: List[ScanSegment] = []
        at, ranges = sensor_in_odom, np.asarray(observation.ranges, dtype=float)
        limits = (observation.range_min, observation.range_max, max_range)
        self.beams, self.points_xy, self._free = _project(
            observation.angles, ranges, limits, (at.x, at.y, at.yaw)
        )
        self.edges = _edges(observation.angles, self.beams)

    def free_share(self, points_xy: np.ndarray) -> float:
        """Compute the share of points that lie in the free space of this scan.

        Args:
            points_xy: (N, 2), in the odom frame [m].

        Returns:
            Share, 0 to 1.
        """
        at = self.sensor_in_odom
        return float(_share_free(points_xy, at.x, at.y, at.yaw, self._free))


class ScanSegment(NamedTuple):
    """Neighbouring points that may be one object.

    Attributes:
        points_xy: (N, 2) in the odom frame [m].
        centre_xy: (2,) centre of the object, one radius behind the nearest point as seen from the sensor [m].
        radius: Radius of the object [m].
        is_occluded: Whether only a part of the object may be visible: a nearer object may hide the rest, or
            it ends at an edge of the field of view or at a neighbour.
    """

    points_xy: np.ndarray
    centre_xy: np.ndarray
    radius: float
    is_occluded: bool


def _edges(angles: np.ndarray, beams: np.ndarray) -> Tuple[bool, bool]:
    """Whether the first and the last beam by angle, of those that end within the range, are the outermost."""
    low, high = float(angles.min()), float(angles.max())
    if not len(beams) or high - low > 2.0 * math.pi - FULL_CIRCLE_GAP:
        return False, False
    return bool(angles[beams[0]] == low), bool(angles[beams[-1]] == high)


def hidden_segment(points_xy: np.ndarray) -> ScanSegment:
    """Create the segment of an object of which only a part is visible.

    Args:
        points_xy: (N, 2), in the odom frame [m].
    """
    low, high = points_xy.min(axis=0), points_xy.max(axis=0)
    return ScanSegment(points_xy, 0.5 * (low + high), 0.5 * float(np.hypot(*(high - low))), True)


def fitted_centre(points_xy: np.ndarray, expected_xy: np.ndarray, radius: float, prior: float) -> np.ndarray:
    """Fit a circle of known radius to points, which may be of one side of the object only.

    Args:
        points_xy: (N, 2) [m].
        expected_xy: (2,) predicted centre [m].
        radius: Radius of the circle [m].
        prior: Weight of the prediction relative to one point.

    Returns:
        Centre (2,) of the least-squares circle [m].
    """
    return _fitted(points_xy, expected_xy, radius, prior)


def segments_of(snapshot: ScanSnapshot) -> List[ScanSegment]:
    """Segment a snapshot; one segment may span the first and the last beam.

    Args:
        snapshot: Points of a scan.
    """
    if len(snapshot.points_xy) < MIN_SEGMENT_BEAMS:
        return []
    at = snapshot.sensor_in_odom
    first, groups, centres = _groups(snapshot.points_xy, at.x, at.y, snapshot.edges)
    points_xy = np.concatenate((snapshot.points_xy[first:], snapshot.points_xy[:first]))
    return [
        ScanSegment(points_xy[int(start) : int(end)], centre[:2], float(centre[2]), bool(is_occluded))
        for (start, end, is_occluded), centre in zip(groups, centres)
    ]


@numba.njit(cache=True)
def _fitted(points_xy, expected_xy, radius, prior):
    """Gauss-Newton from the predicted centre."""
    x, y = expected_xy
    for _ in range(FITTING_STEPS):
        xx = yy = prior
        xy = 0.0
        pull_x, pull_y = prior * (expected_xy[0] - x), prior * (expected_xy[1] - y)
        for i in range(points_xy.shape[0]):
            off_x, off_y = points_xy[i, 0] - x, points_xy[i, 1] - y
            apart = max(math.hypot(off_x, off_y), 1e-6)
            c, s = off_x / apart, off_y / apart
            xx, xy, yy = xx + c * c, xy + c * s, yy + s * s
            pull_x, pull_y = pull_x + c * (apart - radius), pull_y + s * (apart - radius)
        determinant = xx * yy - xy * xy
        x += (yy * pull_x - xy * pull_y) / determinant
        y += (xx * pull_y - xy * pull_x) / determinant
    return np.array((x, y))


@numba.njit(cache=True)
def _project(angles, ranges, limits, place):
    """Project the beams that end within range into the odom frame.

    Args:
        angles: (N,), angles of the beams in the sensor frame [rad].
        ranges: (N,) [m].
        limits: ``range_min`` and ``range_max`` of the sensor and the maximum range [m].
        place: x, y, yaw of the sensor [m, rad].

    Returns:
        Beams (M,) by angle, their end points (M, 2) and the free range (DIRECTIONS,) [m].
    """
    near, free = _beams_and_free_ranges(angles, ranges, limits)
    beams = near
    for i in range(1, near.size):
        if angles[near[i]] < angles[near[i - 1]]:
            beams = near[np.argsort(angles[near])]
            break
    x, y, yaw = place
    c, s = math.cos(yaw), math.sin(yaw)
    points_xy = np.empty((beams.size, 2))
    for i in range(beams.size):
        ahead = ranges[beams[i]] * math.cos(angles[beams[i]])
        aside = ranges[beams[i]] * math.sin(angles[beams[i]])
        points_xy[i, 0] = c * ahead - s * aside + x
        points_xy[i, 1] = s * ahead + c * aside + y
    return beams, points_xy, free


@numba.njit(cache=True)
def _beams_and_free_ranges(angles, ranges, limits):
    """The beams that end within range, and the free range by direction, (DIRECTIONS,)."""
    range_min, range_max, max_range = limits
    near, count = np.empty(ranges.size, dtype=np.int64), 0
    free = np.full(DIRECTIONS, np.inf)
    for i in range(ranges.size):
        far = ranges[i]
        is_hit = np.isfinite(far) and range_min <= far < range_max
        if is_hit and far < max_range:
            near[count] = i
            count += 1
        if not is_hit:
            far = range_max if far == np.inf else 0.0
        direction = _direction_of(angles[i])
        free[direction] = min(free[direction], far)
    for direction in range(DIRECTIONS):
        if free[direction] == np.inf:
            free[direction] = 0.0
    return near[:count].copy(), free


@numba.njit(cache=True)
def _share_free(points_xy, x, y, yaw, free):
    """Share of the points that are nearer to the sensor than the free range."""
    count = 0
    for i in range(points_xy.shape[0]):
        off_x, off_y = points_xy[i, 0] - x, points_xy[i, 1] - y
        direction = _direction_of(math.atan2(off_y, off_x) - yaw)
        count += math.hypot(off_x, off_y) + FREE_MARGIN < free[direction]
    return count / points_xy.shape[0]


@numba.njit(cache=True)
def _direction_of(angle):
    return int(math.floor(angle * (DIRECTIONS / (2.0 * math.pi)))) % DIRECTIONS


@numba.njit(cache=True)
def _groups(points_xy, x, y, edges):
    """Split the scan into narrow groups of points.

    A group counts as occluded if an end of it is that of the field of view or is cut off from a neighbour.

    Returns the first point after a gap; from there on, start and end of each group and whether it is occluded
    (M, 3), and its centre and radius (M, 3), as seen from (x, y).
    """
    size = points_xy.shape[0]
    groups, centres = np.empty((size, 3), dtype=np.int64), np.empty((size, 3))
    first = 0
    while first < size and _gap_before(points_xy, first) <= SEGMENT_GAP:
        first += 1
    start, count = 0, 0
    for end in range(1, size + 1 if first < size else 0):
        if end < size and _gap_before(points_xy, (first + end) % size) <= SEGMENT_GAP:
            continue
        cuts, pieces = _cuts(points_xy, first + start, first + end)
        for piece in range(pieces):
            from_, to = cuts[piece], cuts[piece + 1]
            width = _width(points_xy, from_, to)
            if to - from_ >= MIN_SEGMENT_BEAMS and width <= MAX_SEGMENT_WIDTH:
                centres[count] = _centre_and_radius(points_xy, from_, to, x, y, width)
                is_partial = piece > 0 or piece < pieces - 1
                is_partial |= (edges[0] and from_ % size == 0) or (edges[1] and to % size == 0)
                is_partial |= _hides(points_xy, from_ - 1, from_, x, y) or _hides(points_xy, to, to - 1, x, y)
                groups[count] = from_ - first, to - first, int(is_partial)
                count += 1
        start = end
    return first, groups[:count], centres[:count]


@numba.njit(cache=True)
def _hides(points_xy, i, end, x, y):
    """Whether point ``i``, beside the ``end`` of a segment, is nearer to the sensor at (x, y)."""
    size = points_xy.shape[0]
    off_x, off_y = points_xy[i % size, 0] - x, points_xy[i % size, 1] - y
    end_x, end_y = points_xy[end % size, 0] - x, points_xy[end % size, 1] - y
    to_point, to_end = math.hypot(off_x, off_y), math.hypot(end_x, end_y)
    apart = abs(off_x * end_y - off_y * end_x)
    is_beside = off_x * end_x + off_y * end_y > 0.0 and apart < OCCLUSION_ANGLE * to_point * to_end
    return is_beside and to_point < to_end


@numba.njit(cache=True)
def _cuts(points_xy, start, end):
    """Split a run of points at its concavities: (M + 1,) cuts from ``start`` to ``end``, and M.

    Objects are convex towards the sensor, so a point far behind the hull separates two objects.
    """
    hull, size = np.empty(end - start, dtype=np.int64), 0
    for i in range(start, end):
        while size > 1 and _ahead(points_xy, hull[size - 2], i, hull[size - 1]) <= 0.0:
            size -= 1
        hull[size] = i
        size += 1
    cuts, count = np.empty(size + 1, dtype=np.int64), 1
    cuts[0] = start
    for edge in range(size - 1):
        deepest, depth = 0, MIN_CONCAVITY
        for i in range(hull[edge] + 1, hull[edge + 1]):
            behind = -_ahead(points_xy, hull[edge], hull[edge + 1], i)
            if behind > depth:
                deepest, depth = i, behind
        if deepest:
            cuts[count] = deepest
            count += 1
    cuts[count] = end
    return cuts, count


@numba.njit(cache=True)
def _ahead(points_xy, a, b, i):
    """Distance of point ``i`` in front of the line through ``a`` and ``b``, as seen from the sensor [m]."""
    size = points_xy.shape[0]
    a_x, a_y = points_xy[a % size]
    along_x, along_y = points_xy[b % size, 0] - a_x, points_xy[b % size, 1] - a_y
    off_x, off_y = points_xy[i % size, 0] - a_x, points_xy[i % size, 1] - a_y
    return (along_x * off_y - along_y * off_x) / max(math.hypot(along_x, along_y), 1e-9)


@numba.njit(cache=True)
def _gap_before(points_xy, i):
    """Distance between a point and the one before [m]."""
    return math.hypot(points_xy[i, 0] - points_xy[i - 1, 0], points_xy[i, 1] - points_xy[i - 1, 1])


@numba.njit(cache=True)
def _width(points_xy, start, end):
    """Diagonal of the bounding box [m]; indices wrap around."""
    low_x = low_y = np.inf
    high_x = high_y = -np.inf
    for i in range(start, end):
        at_x, at_y = points_xy[i % points_xy.shape[0]]
        low_x, high_x = min(low_x, at_x), max(high_x, at_x)
        low_y, high_y = min(low_y, at_y), max(high_y, at_y)
    return math.hypot(high_x - low_x, high_y - low_y)


@numba.njit(cache=True)
def _centre_and_radius(points_xy, start, end, x, y, width):
    """Centre (x, y) and radius of an object: half its width, or more if it is round."""
    size = points_xy.shape[0]
    nearest, sum_x, sum_y = np.inf, 0.0, 0.0
    for i in range(start, end):
        off_x, off_y = points_xy[i % size, 0] - x, points_xy[i % size, 1] - y
        nearest = min(nearest, math.hypot(off_x, off_y))
        sum_x, sum_y = sum_x + off_x, sum_y + off_y
    first, last = points_xy[start % size], points_xy[(end - 1) % size]
    round_radius = _radius_if_round(first[0] - x, first[1] - y, last[0] - x, last[1] - y, nearest)
    radius = max(0.5 * width, round_radius)
    away = (nearest + radius) / math.hypot(sum_x, sum_y)
    return x + away * sum_x, y + away * sum_y, radius


@numba.njit(cache=True)
def _radius_if_round(first_x, first_y, last_x, last_y, nearest):
    """Radius of the circle that the outermost beams touch, if the nearest point fits a circle, else 0.

    From nearby, a laser sees far less than half of a circle.
    """
    to_first, to_last = math.hypot(first_x, first_y), math.hypot(last_x, last_y)
    angle_c = (first_x * last_x + first_y * last_y) / max(to_first * to_last, 1e-9)
    c, s = math.sqrt(0.5 * max(1.0 + angle_c, 0.0)), math.sqrt(0.5 * max(1.0 - angle_c, 0.0))
    if s < MIN_SINE or c < MIN_SINE:
        return 0.0
    radius = 0.5 * math.hypot(last_x - first_x, last_y - first_y) / c
    before_ends = radius * (c / s - 1.0 / s + 1.0)
    return radius if min(to_first, to_last) - nearest > MIN_ROUNDNESS * before_ends else 0.0
