"""What a laser sees from a place: how far it was free, and things narrow enough to be somebody."""

import math
from typing import List

import numpy as np

from move_base_lite.costmap import Sighting
from planar import Pose2

# Metres from the sensor up to which movers are looked for, between beams of two things, and across one thing.
REACH, GAP, WIDEST = 4.0, 0.25, 0.9
FEWEST_BEAMS = 3
# Metres by which a beam must have gone beyond a place that was free.
BEYOND = 0.12
DIRECTIONS = 180


class View:
    """A sighting from where it was made: its near ends by angle, and how far it was free."""

    def __init__(self, sensor_in_odom: Pose2, sighting: Sighting):
        self.sensor_in_odom, self.stamp = sensor_in_odom, sighting.stamp
        ranges = np.asarray(sighting.ranges, dtype=float)
        hits = np.isfinite(ranges) & (ranges >= sighting.range_min) & (ranges < sighting.range_max)
        near = hits & (ranges < REACH)
        self.beams = np.flatnonzero(near)[np.argsort(sighting.angles[near])]
        angles = sighting.angles[self.beams]
        ends = np.column_stack((np.cos(angles), np.sin(angles))) * ranges[self.beams, None]
        self.points_xy = sensor_in_odom.transform_points(ends)
        free = np.where(hits, ranges, np.where(ranges == np.inf, sighting.range_max, 0.0))
        self._free = np.full(DIRECTIONS, np.inf)
        np.minimum.at(self._free, _direction_of(sighting.angles), free)
        self._free[np.isinf(self._free)] = 0.0

    def share_seen_through(self, points_xy: np.ndarray) -> float:
        """Which share of points (N, 2) lay in the free then."""
        offsets = self.sensor_in_odom.inverse().transform_points(points_xy)
        free = self._free[_direction_of(np.arctan2(offsets[:, 1], offsets[:, 0]))]
        return float((np.hypot(offsets[:, 0], offsets[:, 1]) + BEYOND < free).mean())


def _direction_of(angles: np.ndarray) -> np.ndarray:
    return np.floor(angles * (DIRECTIONS / (2.0 * math.pi))).astype(int) % DIRECTIONS


class Thing:
    """Neighbouring beams (N, 2) that end on one thing; its middle lies its radius behind the nearest."""

    def __init__(self, points_xy: np.ndarray, sensor_in_odom: Pose2):
        self.points_xy = points_xy
        self.radius = 0.5 * float(np.hypot(*np.ptp(points_xy, axis=0)))
        offsets = points_xy - (sensor_in_odom.x, sensor_in_odom.y)
        ranges = np.hypot(offsets[:, 0], offsets[:, 1])
        direction = offsets.sum(axis=0) / np.hypot(*offsets.sum(axis=0))
        self.middle_xy = (ranges.min() + self.radius) * direction + (sensor_in_odom.x, sensor_in_odom.y)


def things_in(view: View) -> List[Thing]:
    """What is narrow enough to be somebody, of a view; the first and the last beam may be of the same."""
    points_xy = view.points_xy
    if len(points_xy) < FEWEST_BEAMS:
        return []
    steps = np.hypot(*(points_xy - np.roll(points_xy, 1, axis=0)).T)
    starts = np.flatnonzero(steps > GAP)
    if not len(starts):
        return []
    groups = np.split(np.roll(points_xy, -starts[0], axis=0), (starts - starts[0])[1:])
    narrow = [
        group for group in groups if len(group) >= FEWEST_BEAMS and np.hypot(*np.ptp(group, axis=0)) <= WIDEST
    ]
    return [Thing(group, view.sensor_in_odom) for group in narrow]
