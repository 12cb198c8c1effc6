"""What a laser sees from a place: how far it was free, and things narrow enough to be somebody."""

import math
from typing import List, NamedTuple

import numba
import numpy as np

from move_base_lite.costmap import Observation
from planar import Pose2

# Metres between beams of two things, and from corner to corner of what a laser sees of one: a person, a cart,
# another robot.
GAP, WIDEST = 0.25, 1.5
FEWEST_BEAMS = 3
FITTING_STEPS = 3
# Metres behind the hull of neighbouring beams from which on two things meet there.
HOLLOW = 0.15
# Metres by which a beam must have gone beyond a place that was free.
BEYOND = 0.12
DIRECTIONS = 180
# Of half the angle that a thing fills, from which on it shows whether it is round; the share of a circle's
# depth that is enough.
LEAST_SINE, ROUND = 0.2, 0.5


class View:
    """A sighting from where it was made: its ends within ``reach``, m, by angle, and how far it was free."""

    def __init__(self, sensor_in_odom: Pose2, observation: Observation, reach: float):
        self.sensor_in_odom, self.stamp = sensor_in_odom, observation.stamp
        self.things: List[Thing] = []
        at, ranges = sensor_in_odom, np.asarray(observation.ranges, dtype=float)
        limits = (observation.range_min, observation.range_max, reach)
        self.beams, self.points_xy, self._free = _seen(
            observation.angles, ranges, limits, (at.x, at.y, at.yaw)
        )

    def share_seen_through(self, points_xy: np.ndarray) -> float:
        """Which share of points (N, 2) lay in the free then."""
        at = self.sensor_in_odom
        return float(_share_free(points_xy, at.x, at.y, at.yaw, self._free))


class Thing(NamedTuple):
    """Neighbouring beams, ``points_xy`` (N, 2), that end on one thing; its middle lies its radius behind the
    nearest."""

    points_xy: np.ndarray
    middle_xy: np.ndarray
    radius: float


def middle_of(points_xy: np.ndarray, expected_xy: np.ndarray, radius: float, prior: float) -> np.ndarray:
    """The middle (2,) of a thing of which points (N, 2) are seen, perhaps of one side of it alone.

    The circle of that radius that fits them best, by least squares; ``prior``: what a metre off where it is
    ``expected_xy`` weighs beside one of a point.
    """
    return _fitted(points_xy, expected_xy, radius, prior)


def things_in(view: View) -> List[Thing]:
    """What is narrow enough to be somebody, of a view; the first and the last beam may be of the same."""
    if len(view.points_xy) < FEWEST_BEAMS:
        return []
    first, groups, middles = _groups(view.points_xy, view.sensor_in_odom.x, view.sensor_in_odom.y)
    points_xy = np.concatenate((view.points_xy[first:], view.points_xy[:first]))
    return [
        Thing(points_xy[int(start) : int(end)], middle[:2], float(middle[2]))
        for (start, end), middle in zip(groups, middles)
    ]


@numba.njit(cache=True)
def _fitted(points_xy, expected_xy, radius, prior):
    """Gauss-Newton, from where it is expected."""
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
def _seen(angles, ranges, limits, place):
    """The beams that end within reach by angle, (N,), where, (N, 2), and how far it was free, (DIRECTIONS,).

    ``limits``: the laser's and the reach, ``place``: its x, y and yaw.
    """
    near, free = _near_and_free(angles, ranges, limits)
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
def _near_and_free(angles, ranges, limits):
    """The beams that end within reach, and how far it was free, (DIRECTIONS,)."""
    range_min, range_max, reach = limits
    near, count = np.empty(ranges.size, dtype=np.int64), 0
    free = np.full(DIRECTIONS, np.inf)
    for i in range(ranges.size):
        far = ranges[i]
        is_hit = np.isfinite(far) and range_min <= far < range_max
        if is_hit and far < reach:
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
    """Which share of the points lies nearer to a place than it was free from there."""
    count = 0
    for i in range(points_xy.shape[0]):
        off_x, off_y = points_xy[i, 0] - x, points_xy[i, 1] - y
        direction = _direction_of(math.atan2(off_y, off_x) - yaw)
        count += math.hypot(off_x, off_y) + BEYOND < free[direction]
    return count / points_xy.shape[0]


@numba.njit(cache=True)
def _direction_of(angle):
    return int(math.floor(angle * (DIRECTIONS / (2.0 * math.pi)))) % DIRECTIONS


@numba.njit(cache=True)
def _groups(points_xy, x, y):
    """The first point after a gap; from there on, where each narrow group starts and ends, (M, 2), and the x,
    y of its middle and its radius, (M, 3); as seen from (x, y)."""
    size = points_xy.shape[0]
    groups, middles = np.empty((size, 2), dtype=np.int64), np.empty((size, 3))
    first = 0
    while first < size and _apart(points_xy, first) <= GAP:
        first += 1
    start, count = 0, 0
    for end in range(1, size + 1 if first < size else 0):
        if end < size and _apart(points_xy, (first + end) % size) <= GAP:
            continue
        cuts, pieces = _cuts(points_xy, first + start, first + end)
        for piece in range(pieces):
            from_, to = cuts[piece], cuts[piece + 1]
            width = _width(points_xy, from_, to)
            if to - from_ >= FEWEST_BEAMS and width <= WIDEST:
                middles[count] = _middle(points_xy, from_, to, x, y, width)
                groups[count] = from_ - first, to - first
                count += 1
        start = end
    return first, groups[:count], middles[:count]


@numba.njit(cache=True)
def _cuts(points_xy, start, end):
    """Where neighbouring points are to be parted, since two things meet there: (M + 1,), from ``start`` to
    ``end``, and M.

    Things bulge towards who sees them, so that what lies far behind the hull is where one ends.
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
        deepest, depth = 0, HOLLOW
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
    """How far, metres, a point lies before the line through two others, as seen from where all were seen."""
    size = points_xy.shape[0]
    a_x, a_y = points_xy[a % size]
    along_x, along_y = points_xy[b % size, 0] - a_x, points_xy[b % size, 1] - a_y
    off_x, off_y = points_xy[i % size, 0] - a_x, points_xy[i % size, 1] - a_y
    return (along_x * off_y - along_y * off_x) / max(math.hypot(along_x, along_y), 1e-9)


@numba.njit(cache=True)
def _apart(points_xy, i):
    """Metres between a point and the one before."""
    return math.hypot(points_xy[i, 0] - points_xy[i - 1, 0], points_xy[i, 1] - points_xy[i - 1, 1])


@numba.njit(cache=True)
def _width(points_xy, start, end):
    """Metres from corner to corner; the points go on behind the last with the first."""
    low_x = low_y = np.inf
    high_x = high_y = -np.inf
    for i in range(start, end):
        at_x, at_y = points_xy[i % points_xy.shape[0]]
        low_x, high_x = min(low_x, at_x), max(high_x, at_x)
        low_y, high_y = min(low_y, at_y), max(high_y, at_y)
    return math.hypot(high_x - low_x, high_y - low_y)


@numba.njit(cache=True)
def _middle(points_xy, start, end, x, y, width):
    """The middle of a thing, x and y, and its radius: half its width, or more if it is round."""
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
    """Of the circle that the outermost beams touch, if the nearest lies as far before them as it would; else
    0. From near, a laser sees far less than half of it.
    """
    to_first, to_last = math.hypot(first_x, first_y), math.hypot(last_x, last_y)
    angle_c = (first_x * last_x + first_y * last_y) / max(to_first * to_last, 1e-9)
    c, s = math.sqrt(0.5 * max(1.0 + angle_c, 0.0)), math.sqrt(0.5 * max(1.0 - angle_c, 0.0))
    if s < LEAST_SINE or c < LEAST_SINE:
        return 0.0
    radius = 0.5 * math.hypot(last_x - first_x, last_y - first_y) / c
    before_ends = radius * (c / s - 1.0 / s + 1.0)
    return radius if min(to_first, to_last) - nearest > ROUND * before_ends else 0.0
