"""Where the object of an errand is, as far as one can see it."""

from typing import Optional

from planar import Pose2
from planar.maps.places import Place


class CarriedParcel:
    """An object that waits at pick-up, leaves with the robot and is set down at drop-off."""

    def __init__(self, pickup: Place, dropoff: Place, pickup_seconds: float):
        self._pickup = pickup
        self._dropoff = dropoff
        self._pickup_seconds = pickup_seconds
        self._arrived_at: Optional[float] = None
        self._is_carried = False
        self._is_delivered = False

    def update(self, now: float, robot: Optional[Pose2]) -> Optional[Pose2]:
        """Where the object is shown, or None while it is hidden. ``robot``: its pose in the map, if known."""
        if self._is_delivered:
            return self._dropoff.pose
        if robot is None:
            return None if self._is_carried else self._pickup.pose
        if self._is_carried:
            self._is_delivered = self._dropoff.holds(robot)
            return self._dropoff.pose if self._is_delivered else None
        if not self._pickup.holds(robot):
            self._arrived_at = None
        elif self._arrived_at is None:
            self._arrived_at = now
        self._is_carried = self._arrived_at is not None and now - self._arrived_at >= self._pickup_seconds
        return None if self._is_carried else self._pickup.pose


class TimedParcel:
    """An object shown at pick-up, hidden, and shown at drop-off, by the clock alone."""

    def __init__(self, pickup: Place, dropoff: Place, show_seconds: float, hide_seconds: float):
        self._pickup = pickup
        self._dropoff = dropoff
        self._hide_after = show_seconds
        self._show_after = show_seconds + hide_seconds
        self._start: Optional[float] = None

    def update(self, now: float, robot: Optional[Pose2] = None) -> Optional[Pose2]:
        """Where the object is shown, or None while it is hidden; the clock starts with the first call."""
        if self._start is None:
            self._start = now
        elapsed = now - self._start
        if elapsed < self._hide_after:
            return self._pickup.pose
        return None if elapsed < self._show_after else self._dropoff.pose
