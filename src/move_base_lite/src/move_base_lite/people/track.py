"""A thing that is tracked."""

import math
from typing import Tuple

import numpy as np

from move_base_lite.people.views import Thing

# Standard deviations of where a thing is seen (m), of its acceleration (m/s^2) and its first velocity (m/s).
SEEN, ACCELERATION, FIRST_VELOCITY = 0.06, 1.0, 0.8
# Standard deviations and metres within which a sighting belongs to a track.
GATE, GATE_METRES = 3.0, 0.2
# m/s from which on a thing moves, and standard deviation from which on its velocity is known.
MOVING, KNOWN = 0.15, 0.35
# Metres around what has moved that belong to it.
AROUND = 0.1


class Track:
    """A thing at constant velocity (Kalman filter; both axes alike, so one covariance serves them)."""

    def __init__(self, thing: Thing, stamp: float):
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

    def may_be(self, thing: Thing) -> bool:
        """Whether nothing else has been taken for it in this view, and the thing is near enough."""
        reach = GATE * math.sqrt(self._covariance[0, 0]) + GATE_METRES
        return self.seen_at < self._stamp and self.distance_to(thing) < reach

    def distance_to(self, thing: Thing) -> float:
        return math.dist(self._position, thing.middle_xy)

    def correct(self, thing: Thing, has_come: bool) -> None:
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
