"""Location of the errand's object, derived from the robot's pose or from the clock."""

import enum
from typing import Optional

from planar import Pose2
from planar.elapsed_time import ElapsedTime
from planar.maps.places import NamedPlace


class ParcelStage(enum.Enum):
    """Stage of the object."""

    WAITING = "waiting"
    CARRIED = "carried"
    DELIVERED = "delivered"


class CarriedParcel:
    """An object that waits at pick-up, is carried by the robot, and is set down at drop-off.

    Args:
        pickup: Place where it waits.
        dropoff: Place where it is set down.
        pickup_seconds: Time that the robot stays at pick-up until it has the object [s].
        stage: Stage to start from.

    Attributes:
        stage: Current stage.
    """

    def __init__(
        self,
        pickup: NamedPlace,
        dropoff: NamedPlace,
        pickup_seconds: float,
        stage: ParcelStage = ParcelStage.WAITING,
    ):
        self.stage = stage
        self._pickup = pickup
        self._dropoff = dropoff
        self._pickup_seconds = pickup_seconds
        self._elapsed = ElapsedTime()
        self._arrived_at: Optional[float] = None

    def update(self, now: float, robot: Optional[Pose2]) -> Optional[Pose2]:
        """Advance to the current time.

        Args:
            now: Time [s].
            robot: Pose of the robot in the map; None if it is not known.

        Returns:
            Pose where the object is shown; None while it is hidden.
        """
        if robot is not None:
            self._follow(self._elapsed.update(now), robot)
        return {ParcelStage.WAITING: self._pickup.pose, ParcelStage.DELIVERED: self._dropoff.pose}.get(
            self.stage
        )

    def _follow(self, now: float, robot: Pose2) -> None:
        if self.stage is ParcelStage.CARRIED and self._dropoff.contains(robot):
            self.stage = ParcelStage.DELIVERED
        elif self.stage is ParcelStage.WAITING:
            if not self._pickup.contains(robot):
                self._arrived_at = None
            elif self._arrived_at is None:
                self._arrived_at = now
            if self._arrived_at is not None and now - self._arrived_at >= self._pickup_seconds:
                self.stage = ParcelStage.CARRIED


class TimedParcel:
    """An object that is shown at pick-up, hidden, and shown at drop-off, by the clock alone."""

    def __init__(self, pickup: NamedPlace, dropoff: NamedPlace, show_seconds: float, hide_seconds: float):
        self._pickup = pickup
        self._dropoff = dropoff
        self._hide_after = show_seconds
        self._show_after = show_seconds + hide_seconds
        self._elapsed = ElapsedTime()

    def update(self, now: float, robot: Optional[Pose2] = None) -> Optional[Pose2]:
        """Return the pose where the object is shown, None while it is hidden. The first call starts it."""
        elapsed = self._elapsed.update(now)
        if elapsed < self._hide_after:
            return self._pickup.pose
        return None if elapsed < self._show_after else self._dropoff.pose
