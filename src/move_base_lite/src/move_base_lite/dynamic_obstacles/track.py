"""The track of one object: a Kalman filter with a constant-velocity model."""

import math
from typing import Tuple

import numpy as np

from move_base_lite.dynamic_obstacles.scan_segments import ScanSegment, ScanSnapshot, fitted_centre

# Standard deviations of a segment's position [m], the acceleration [m/s^2] and the first velocity [m/s].
MEASUREMENT_SIGMA, ACCELERATION_SIGMA, INITIAL_VELOCITY_SIGMA = 0.03, 3.0, 0.8
# Highest speed of an object: a wrong match must not send it away [m/s].
MAX_SPEED = 2.5
# Gate of the association: standard deviations, and a margin [m].
GATE_SIGMAS, GATE_MARGIN = 3.0, 0.2
# Innovation in standard deviations above which the object has manoeuvred and its velocity is uncertain again.
MANOEUVRE_SIGMAS = 2.0
# Speed of a moving object [m/s], and the standard deviation below which the velocity counts as known [m/s].
MIN_MOVING_SPEED, MAX_VELOCITY_SIGMA = 0.15, 0.35
# Speed [m/s] and displacement [m] of a moving object if it is unknown whether its place was free before.
MIN_TRAVEL_SPEED, MIN_TRAVEL = 0.5, 0.2
# Time by which an object of unknown place must have travelled so far [s].
MAX_TRAVEL_TIME = 0.5
# Share of a segment's points that must lie where it was free before, and of an object's first points that
# must be free now.
MIN_FREE_SHARE, MIN_VACATED_SHARE = 0.5, 0.9
# Limits of a radius's change from scan to scan: partial occlusion shrinks a segment, a neighbour enlarges it.
MIN_RADIUS_RATIO, MAX_RADIUS_RATIO = 0.98, 1.1
# Relative growth from scan to scan of a radius that was seen as a whole, times the number of scans since.
MAX_KNOWN_RADIUS_GROWTH = 0.2
# Ratio of a segment's radius to a moving object's above which the segment is of several objects.
MERGED_RATIO = 1.1
# Time after its last motion for which an object counts as dynamic, as it may start again [s].
MOVING_MEMORY = 4.0
# Displacement from which on a moving object may be expected to start again: shadows of others move less [m].
MIN_MOBILE_TRAVEL = 0.5
# Points within this distance of the object belong to it [m].
COVER_MARGIN = 0.1


class Track:
    """An object at constant velocity (Kalman filter; x and y share one covariance).

    Attributes:
        is_moving: Whether the object moved when the velocity was last known: either it was where the space
            was free before, or it had travelled fast and far since it was first seen and entered free space.
            The latter excludes static objects, whose segments seem to move as other objects occlude them.
        is_static: Whether the object stood when the velocity was last known, and had never moved.
        is_radius_known: Whether the whole object has been seen; the radius is a lower bound otherwise.
        seen_at: Time of the last matching segment [s].
        moved_at: Time at which it last moved [s].
    """

    def __init__(self, segment: ScanSegment, stamp: float):
        """Start a track without velocity.

        Args:
            segment: First segment of the object.
            stamp: Time of the scan [s].
        """
        self._position, self._velocity = segment.centre_xy, np.zeros(2)
        self._covariance = np.diag([MEASUREMENT_SIGMA**2, INITIAL_VELOCITY_SIGMA**2])
        self._radius, self._stamp, self.seen_at = segment.radius, stamp, stamp
        self._first_points_xy, self._first_stamp = segment.points_xy, stamp
        self._first_xy, self.is_radius_known = self._position, not segment.is_occluded
        self.is_moving = self.is_static = False
        self.moved_at = -math.inf
        self._entered_free_space = self._is_mobile = False
        self._observations = 0

    @property
    def is_dynamic(self) -> bool:
        """Whether the object moves or has moved lately, so that it may start again at any time."""
        return self.is_moving or (self._is_mobile and self._stamp - self.moved_at <= MOVING_MEMORY)

    def predict(self, stamp: float) -> None:
        """Predict the state at a time.

        Args:
            stamp: Time of the prediction [s].
        """
        dt = stamp - self._stamp
        self._stamp = stamp
        self._position = self._position + dt * self._velocity
        motion = np.array([[1.0, dt], [0.0, 1.0]])
        noise = np.array([0.5 * dt * dt, dt])
        self._covariance = motion @ self._covariance @ motion.T + ACCELERATION_SIGMA**2 * np.outer(
            noise, noise
        )

    def can_match(self, segment: ScanSegment, seen_since: float) -> bool:
        """Check whether a segment is within the gate and the track has no segment in this scan yet.

        Args:
            segment: Segment of the present scan.
            seen_since: Time before which a track without match is too old [s].
        """
        gate = GATE_SIGMAS * math.sqrt(self._covariance[0, 0]) + GATE_MARGIN
        is_unmatched = seen_since <= self.seen_at < self._stamp
        return is_unmatched and self.distance_to(segment) < gate

    def distance_to(self, segment: ScanSegment) -> float:
        """Distance to the segment's centre [m]; of a partly hidden object, with the radius seen before."""
        if segment.is_occluded and segment.radius < self._radius:
            return math.dist(self._position, self._fitted_centre(segment))
        return math.dist(self._position, segment.centre_xy)

    def _fitted_centre(self, segment: ScanSegment) -> np.ndarray:
        prior = MEASUREMENT_SIGMA**2 / self._covariance[0, 0]
        return fitted_centre(segment.points_xy, self._position, self._radius, prior)

    def boundary_distance(self, points_xy: np.ndarray) -> np.ndarray:
        """Compute the distance of points from the object's predicted outline.

        Args:
            points_xy: (N, 2), in the odom frame [m].

        Returns:
            (N,) [m].
        """
        return np.abs(np.hypot(*(points_xy - self._position).T) - self._radius)

    def is_narrower_than(self, segment: ScanSegment) -> bool:
        """Check whether a segment near the object is too wide to be the object alone.

        Args:
            segment: Segment of the present scan.
        """
        reach = self._radius + segment.radius
        return (
            self.is_dynamic
            and segment.radius > MERGED_RATIO * self._radius
            and math.dist(self._position, segment.centre_xy) < reach
        )

    def is_alive(self, snapshot: ScanSnapshot, visible_age: float, occluded_age: float) -> bool:
        """Check whether the track has matched a segment recently enough.

        Args:
            snapshot: The present scan.
            visible_age: Largest time since the last match if the scan shows that its place is free [s].
            occluded_age: Largest time since the last match otherwise [s].
        """
        is_free = snapshot.free_share(self._position[None, :]) > 0.0
        return snapshot.stamp - self.seen_at <= (visible_age if is_free else occluded_age)

    def has_left_its_place(self, snapshot: ScanSnapshot) -> bool:
        """Check whether the place where the object was first seen is free now.

        Args:
            snapshot: The present scan.
        """
        return snapshot.free_share(self._first_points_xy) >= MIN_VACATED_SHARE

    def correct(self, segment: ScanSegment, was_free: bool, was_free_recently: bool) -> None:
        """Correct the state with a matching segment.

        Args:
            segment: Segment of the present scan.
            was_free: Whether it lies where the space was free in the reference scan.
            was_free_recently: The same for the reference scan or a more recent one, or whether the object has
                left its first place.
        """
        self._entered_free_space = self._entered_free_space or was_free_recently
        self._correct_radius(segment)
        innovation = self._fitted_centre(segment) - self._position
        self._allow_for_manoeuvre(math.hypot(*innovation))
        gain = self._covariance[:, 0] / (self._covariance[0, 0] + MEASUREMENT_SIGMA**2)
        self._position = self._position + gain[0] * innovation
        self._velocity = self._velocity + gain[1] * innovation
        self._velocity = self._velocity * min(1.0, MAX_SPEED / max(math.hypot(*self._velocity), 1e-9))
        self._covariance = self._covariance - np.outer(gain, self._covariance[0])
        self.seen_at = self._stamp
        if self._covariance[1, 1] < MAX_VELOCITY_SIGMA**2:
            speed = math.hypot(*self._velocity)
            has_travelled = (
                self._entered_free_space
                and speed >= MIN_TRAVEL_SPEED
                and math.dist(self._position, self._first_xy) >= MIN_TRAVEL
            )
            self.is_moving = (was_free and speed >= MIN_MOVING_SPEED) or has_travelled
            is_old = self._stamp - self._first_stamp >= MAX_TRAVEL_TIME
            has_never_moved = not was_free and self.moved_at == -math.inf and not self.is_moving
            self.is_static = has_never_moved and (is_old or speed < MIN_TRAVEL_SPEED)
        if self.is_moving:
            self.moved_at = self._stamp
            self._is_mobile |= math.dist(self._position, self._first_xy) >= MIN_MOBILE_TRAVEL

    def _correct_radius(self, segment: ScanSegment) -> None:
        """Correct the radius; one that was seen in part only was a lower bound, and the centre a guess."""
        if segment.is_occluded or self.is_radius_known:
            min_ratio = 1.0 if segment.is_occluded else MIN_RADIUS_RATIO
            max_ratio = MAX_RADIUS_RATIO
            if self.is_radius_known:
                self._observations += 1
                max_ratio = 1.0 + MAX_KNOWN_RADIUS_GROWTH / self._observations
            self._radius *= min(max(segment.radius / self._radius, min_ratio), max_ratio)
            return
        self.is_radius_known = True
        if segment.radius > self._radius:
            self._radius, self._position = segment.radius, segment.centre_xy
            self._covariance[1, 1] = max(self._covariance[1, 1], INITIAL_VELOCITY_SIGMA**2)

    def _allow_for_manoeuvre(self, innovation: float) -> None:
        """Make the velocity uncertain if the innovation [m] is too large for the track.

        A dynamic object has turned or started since the last match, by as much as the innovation shows. The
        segment of another one may have shifted because something occludes it.
        """
        if innovation <= MANOEUVRE_SIGMAS * math.sqrt(self._covariance[0, 0] + MEASUREMENT_SIGMA**2):
            return
        if not self.is_dynamic:
            self._covariance[1, 1] += INITIAL_VELOCITY_SIGMA**2
            return
        dt = self._stamp - self.seen_at
        motion = np.array([dt, 1.0])
        added = max(INITIAL_VELOCITY_SIGMA**2, (innovation / dt) ** 2)
        self._covariance = self._covariance + added * np.outer(motion, motion)

    def covers(self, points_xy: np.ndarray) -> np.ndarray:
        """Find the points on the object.

        Args:
            points_xy: (N, 2), in the odom frame [m].

        Returns:
            (N,) booleans.
        """
        return np.hypot(*(points_xy - self._position).T) < self._radius + COVER_MARGIN

    def state_at(self, now: float) -> Tuple[float, float, float, float, float]:
        """Predict x, y, vx, vy and radius in the odom frame [m, m/s].

        Args:
            now: Time of the prediction [s].
        """
        x, y = self._position + (now - self._stamp) * self._velocity
        return (float(x), float(y), float(self._velocity[0]), float(self._velocity[1]), self._radius)
