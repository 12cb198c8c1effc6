"""A thing that is tracked."""

import math
from typing import Tuple

import numpy as np

from move_base_lite.people.views import Thing, View, middle_of

# Standard deviations of where a thing is seen (m), of its acceleration (m/s^2) and its first velocity (m/s).
SEEN, ACCELERATION, FIRST_VELOCITY = 0.03, 3.0, 0.8
# Standard deviations and metres within which a sighting belongs to a track.
GATE, GATE_METRES = 3.0, 0.2
# Standard deviations off from which on a thing must have turned: its velocity is anybody's guess again.
TURNED = 2.0
# m/s from which on a thing moves, and standard deviation from which on its velocity is known.
MOVING, KNOWN = 0.15, 0.35
# m/s and metres by which a thing shows that it moves, if it is not known whether it was free there before.
FAST, WAY = 0.5, 0.2
# How fast a radius changes, from view to view: of a thing that is partly hidden less is seen, and beside
# another one more.
SHRINKING, GROWING = 0.98, 1.1
# Metres around what has moved that belong to it.
AROUND = 0.1


class Track:
    """A thing at constant velocity (Kalman filter; both axes alike, so one covariance serves them).

    When its velocity was last known it surely moved, ``is_moving``: it had come where it was free, or had
    gone far and fast while it was watched, and entered what was free: what stands seems to go, too, as other
    things hide one side of it after the other. Or it surely stood, ``stands``, and had never moved.
    """

    def __init__(self, thing: Thing, stamp: float):
        self._position, self._velocity = thing.middle_xy, np.zeros(2)
        self._covariance = np.diag([SEEN**2, FIRST_VELOCITY**2])
        self._radius, self._stamp, self.seen_at = thing.radius, stamp, stamp
        self._first_xy = self._position
        self.is_moving = self.stands = False
        self.moved_at = -math.inf
        self._has_entered = False

    def predict(self, stamp: float) -> None:
        """Moves on in time."""
        dt = stamp - self._stamp
        self._stamp = stamp
        self._position = self._position + dt * self._velocity
        motion = np.array([[1.0, dt], [0.0, 1.0]])
        push = np.array([0.5 * dt * dt, dt])
        self._covariance = motion @ self._covariance @ motion.T + ACCELERATION**2 * np.outer(push, push)

    def may_be(self, thing: Thing, seen_since: float) -> bool:
        """Whether nothing else has been taken for it in this view, and the thing is near enough.

        Only a track that has been seen from then on may be it.
        """
        reach = GATE * math.sqrt(self._covariance[0, 0]) + GATE_METRES
        is_free = seen_since <= self.seen_at < self._stamp
        return is_free and self.distance_to(thing) < reach

    def distance_to(self, thing: Thing) -> float:
        return math.dist(self._position, thing.middle_xy)

    def may_still_be(self, view: View, gone: float, hidden: float) -> bool:
        """Whether it has been seen lately: within ``gone`` seconds where the view shows its place free, else
        within ``hidden`` seconds.
        """
        is_free = view.share_seen_through(self._position[None, :]) > 0.0
        return view.stamp - self.seen_at <= (gone if is_free else hidden)

    def correct(self, thing: Thing, has_come: bool, has_entered: bool) -> None:
        """Is there; ``has_come``: where it was free a while before; ``has_entered``: or shortly before."""
        self._has_entered = self._has_entered or has_entered
        self._radius *= min(max(thing.radius / self._radius, SHRINKING), GROWING)
        prior = SEEN**2 / self._covariance[0, 0]
        off = middle_of(thing.points_xy, self._position, self._radius, prior) - self._position
        if math.hypot(*off) > TURNED * math.sqrt(self._covariance[0, 0] + SEEN**2):
            self._covariance[1, 1] += FIRST_VELOCITY**2
        gain = self._covariance[:, 0] / (self._covariance[0, 0] + SEEN**2)
        self._position = self._position + gain[0] * off
        self._velocity = self._velocity + gain[1] * off
        self._covariance = self._covariance - np.outer(gain, self._covariance[0])
        self.seen_at = self._stamp
        if self._covariance[1, 1] < KNOWN**2:
            speed = math.hypot(*self._velocity)
            has_gone = (
                self._has_entered and speed >= FAST and math.dist(self._position, self._first_xy) >= WAY
            )
            self.is_moving = (has_come and speed >= MOVING) or has_gone
            self.stands = not has_come and self.moved_at == -math.inf and not self.is_moving
        if self.is_moving:
            self.moved_at = self._stamp

    def covers(self, points_xy: np.ndarray) -> np.ndarray:
        """Which of some points (N, 2) are on it."""
        return np.hypot(*(points_xy - self._position).T) < self._radius + AROUND

    def ahead(self, now: float) -> Tuple[float, float, float, float, float]:
        """Where it is by then: x, y, velocity by x and y, radius."""
        x, y = self._position + (now - self._stamp) * self._velocity
        return (float(x), float(y), float(self._velocity[0]), float(self._velocity[1]), self._radius)
