"""What moves near the robot: beams that end together where it was free, tracked at constant velocity."""

import math
from collections import deque
from dataclasses import replace
from typing import Deque, List, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from move_base_lite.costmap import Sighting
from planar import Pose2

# Metres from the sensor up to which movers are looked for, between beams of two things, and across one thing.
REACH, GAP, WIDEST = 4.0, 0.25, 0.9
FEWEST_BEAMS = 3
# Seconds after which a place is looked at again, and metres by which a beam must have gone beyond it.
LOOK_BACK, BEYOND = 1.0, 0.12
# Share of a thing's beams that must end where it was free before.
SHARE_FREE = 0.5
DIRECTIONS = 180
# Standard deviations of where a thing is seen (m), of its acceleration (m/s^2) and its first velocity (m/s).
SEEN, ACCELERATION, FIRST_VELOCITY = 0.06, 1.0, 0.8
# Standard deviations and metres within which a sighting belongs to a track; seconds that it may be hidden.
GATE, GATE_METRES, HIDDEN = 3.0, 0.2, 0.6
# m/s from which on a thing moves, and standard deviation from which on its velocity is known.
MOVING, KNOWN = 0.15, 0.35
# Seconds for which what has moved is not taken for an obstacle that stays, and metres around it.
MOVED_LATELY, AROUND = 4.0, 0.1
NO_MOVERS = np.empty((0, 5))


class Movers:
    """Tracks what a laser sees moving; the frame is odometry's, which is smooth."""

    def __init__(self) -> None:
        self._past: Deque[_View] = deque()
        self._tracks: List[_Track] = []

    def look(self, base_in_odom: Pose2, sighting: Sighting) -> Sighting:
        """Takes in the newest scan, made from there; returns it without what has moved lately."""
        if self._past and sighting.stamp < self._past[-1].stamp:
            self._past.clear()
            self._tracks.clear()
        view = _View(base_in_odom @ sighting.sensor_in_base, sighting)
        things = _things_in(view)
        before = self._view_before(view.stamp)
        for track in self._tracks:
            track.predict(view.stamp)
        for thing in things:
            has_come = before is not None and before.share_seen_through(thing.points_xy) >= SHARE_FREE
            own = self._track_of(thing)
            if own is not None:
                own.correct(thing, has_come)
            elif has_come:
                self._tracks.append(_Track(thing, view.stamp))
        self._tracks = [track for track in self._tracks if view.stamp - track.seen_at <= HIDDEN]
        self._past.append(view)
        return replace(sighting, ranges=self._lasting(view, sighting.ranges))

    def at(self, now: float) -> NDArray[np.float64]:
        """What moves: rows (N, 5) of x, y, its velocity by x and y, and radius; metres, m/s, in odom."""
        moving = [track.ahead(now) for track in self._tracks if track.is_moving]
        return np.array(moving) if moving else NO_MOVERS

    def _lasting(self, view: "_View", ranges: np.ndarray) -> np.ndarray:
        """The ranges (N,), NaN where a beam ends on what has moved lately."""
        lasting = np.array(ranges)
        for track in self._tracks:
            if view.stamp - track.moved_at <= MOVED_LATELY:
                lasting[view.beams[track.covers(view.points_xy)]] = np.nan
        return lasting

    def _view_before(self, stamp: float) -> Optional["_View"]:
        """The newest view that is old enough to tell what was free; None if there is none yet."""
        while len(self._past) > 1 and stamp - self._past[1].stamp >= LOOK_BACK:
            self._past.popleft()
        is_there = self._past and stamp - self._past[0].stamp >= LOOK_BACK
        return self._past[0] if is_there else None

    def _track_of(self, thing: "_Thing") -> Optional["_Track"]:
        """The nearest track that the thing may belong to and that nothing else belongs to."""
        candidates = [track for track in self._tracks if track.may_be(thing)]
        return min(candidates, key=lambda track: track.distance_to(thing)) if candidates else None


class _View:
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


class _Thing:
    """Neighbouring beams (N, 2) that end on one thing; its middle lies its radius behind the nearest."""

    def __init__(self, points_xy: np.ndarray, sensor_in_odom: Pose2):
        self.points_xy = points_xy
        self.radius = 0.5 * float(np.hypot(*np.ptp(points_xy, axis=0)))
        offsets = points_xy - (sensor_in_odom.x, sensor_in_odom.y)
        ranges = np.hypot(offsets[:, 0], offsets[:, 1])
        direction = offsets.sum(axis=0) / np.hypot(*offsets.sum(axis=0))
        self.middle_xy = (ranges.min() + self.radius) * direction + (sensor_in_odom.x, sensor_in_odom.y)


def _things_in(view: _View) -> List[_Thing]:
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
    return [_Thing(group, view.sensor_in_odom) for group in narrow]


class _Track:
    """A thing at constant velocity (Kalman filter; both axes alike, so one covariance serves them)."""

    def __init__(self, thing: _Thing, stamp: float):
        self._position, self._velocity = thing.middle_xy, np.zeros(2)
        self._covariance = np.diag([SEEN**2, FIRST_VELOCITY**2])
        self._radius, self._stamp, self.seen_at, self._has_come = thing.radius, stamp, stamp, True
        self.moved_at = -math.inf

    def predict(self, stamp: float) -> None:
        """Moves on in time."""
        dt = stamp - self._stamp
        self._stamp = stamp
        self._position = self._position + dt * self._velocity
        motion = np.array([[1.0, dt], [0.0, 1.0]])
        push = np.array([0.5 * dt * dt, dt])
        self._covariance = motion @ self._covariance @ motion.T + ACCELERATION**2 * np.outer(push, push)

    def may_be(self, thing: _Thing) -> bool:
        """Whether nothing else has been taken for it in this view, and the thing is near enough."""
        reach = GATE * math.sqrt(self._covariance[0, 0]) + GATE_METRES
        return self.seen_at < self._stamp and self.distance_to(thing) < reach

    def distance_to(self, thing: _Thing) -> float:
        return math.dist(self._position, thing.middle_xy)

    def correct(self, thing: _Thing, has_come: bool) -> None:
        """Is seen there; ``has_come``: where it was free before."""
        gain = self._covariance[:, 0] / (self._covariance[0, 0] + SEEN**2)
        off = thing.middle_xy - self._position
        self._position = self._position + gain[0] * off
        self._velocity = self._velocity + gain[1] * off
        self._covariance = self._covariance - np.outer(gain, self._covariance[0])
        self._radius = max(thing.radius, 0.9 * self._radius)
        self.seen_at, self._has_come = self._stamp, has_come
        if self.is_moving:
            self.moved_at = self._stamp

    @property
    def is_moving(self) -> bool:
        is_known = self._covariance[1, 1] < KNOWN**2
        return self._has_come and is_known and math.hypot(*self._velocity) >= MOVING

    def covers(self, points_xy: np.ndarray) -> np.ndarray:
        """Which of some points (N, 2) are on it."""
        return np.hypot(*(points_xy - self._position).T) < self._radius + AROUND

    def ahead(self, now: float) -> Tuple[float, float, float, float, float]:
        """Where it is by then: x, y, velocity by x and y, radius."""
        x, y = self._position + (now - self._stamp) * self._velocity
        return (float(x), float(y), float(self._velocity[0]), float(self._velocity[1]), self._radius)
