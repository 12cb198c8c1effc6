"""Estimate of driving times from the speed so far."""

from typing import Optional, Sequence

from pick_objects.job import ENDED, DeliveryJob, DeliveryStage
from pick_objects.mission import Mission
from planar import Pose2
from planar.maps.places import NamedPlace

INITIAL_SPEED = 0.3
# Length of a path in a home divided by the straight-line distance.
DETOUR_FACTOR = 1.3
# Time that a search is estimated to take [s].
SEARCH_SECONDS = 120.0


class DrivingTimeEstimator:
    """Estimates driving times from straight-line distances and the average speed so far.

    Args:
        speed: Assumed speed before any drive was measured [m/s].
    """

    def __init__(self, speed: float = INITIAL_SPEED):
        self._initial_speed = speed
        self._metres = self._seconds = 0.0
        self._departed_at: Optional[float] = None
        self._leg_metres = 0.0

    def seconds_between(self, start: Pose2, end: Pose2) -> float:
        """Return the estimated time to drive from one pose to another [s]."""
        return DETOUR_FACTOR * start.distance_to(end) / self._speed

    def on_departure(self, now: float, start: Optional[Pose2], end: Pose2) -> None:
        """The robot leaves ``start``, if that is known, for ``end``."""
        self._departed_at = now
        self._leg_metres = DETOUR_FACTOR * start.distance_to(end) if start else 0.0

    def on_arrival(self, now: float) -> None:
        """The robot has arrived; the drive is added to the average."""
        if self._departed_at is not None and self._leg_metres > 0.0:
            self._metres += self._leg_metres
            self._seconds += now - self._departed_at
        self._departed_at = None

    def seconds_left(self, now: float) -> float:
        """Return the estimated rest of the current drive [s]."""
        if self._departed_at is None:
            return 0.0
        return max(0.0, self._leg_metres / self._speed - (now - self._departed_at))

    def seconds_for(
        self, jobs: Sequence[DeliveryJob], mission: Mission, where: Optional[NamedPlace]
    ) -> float:
        """Return the estimated time of all that is left to do after the current drive [s].

        Args:
            jobs: Deliveries in their order.
            mission: The mission.
            where: Where the current drive ends; None if it is not known.
        """
        left, settings = 0.0, mission.settings
        for job in jobs:
            if job.stage in ENDED:
                continue
            source, destination = (
                mission.places.get(name) for name in (job.delivery.source, job.delivery.destination)
            )
            if source is None and job.stage.value < DeliveryStage.PICKING_UP.value:
                left += SEARCH_SECONDS
            elif source and where and job.stage.value < DeliveryStage.PICKING_UP.value:
                left += self.seconds_between(where.pose, source.pose)
            if destination is None:
                continue
            if job.stage.value < DeliveryStage.CARRYING.value:
                left += settings.pickup_seconds
                left += self.seconds_between(source.pose, destination.pose) if source else 0.0
            left, where = left + settings.dropoff_seconds, destination
        return left

    @property
    def _speed(self) -> float:
        """Average speed, with a prior of ten seconds at the initial speed."""
        prior_seconds = 10.0
        metres = self._metres + prior_seconds * self._initial_speed
        return metres / (self._seconds + prior_seconds)
