"""The errand: go to the pick-up zone, pick up, go to the drop-off zone."""

import enum
from dataclasses import dataclass
from typing import Optional, Union

from pick_objects.config import ErrandSettings
from planar.driving import Finish, GoalReached, GoalRefused
from planar.places import Place


class ErrandState(enum.Enum):
    """What the robot is about; the values are what ``~state`` publishes."""

    READY = "ready"
    GOING_TO_PICKUP = "going to pickup"
    PICKING_UP = "picking up"
    GOING_TO_DROPOFF = "going to dropoff"
    DELIVERED = "delivered"
    FAILED = "failed"


@dataclass(frozen=True)
class GoTo:
    """Order: drive to this place. It takes the place of any earlier order."""

    place: Place
    attempt: int


Order = Union[GoTo, Finish]
Event = Union[GoalReached, GoalRefused]


class Errand:
    """A delivery between two places, told the time and what happened, answering what to do next."""

    def __init__(self, pickup: Place, dropoff: Place, settings: ErrandSettings = ErrandSettings()):
        self._pickup = pickup
        self._dropoff = dropoff
        self._settings = settings
        self._attempt = 0
        self._since = 0.0
        self._retry_at: Optional[float] = None
        self.state = ErrandState.READY

    def advance(self, now: float, event: Optional[Event] = None) -> Optional[Order]:
        """The next order, or None to carry on. ``now``: seconds; ``event``: what came of the last order."""
        if self.state is ErrandState.READY:
            return self._go(now, ErrandState.GOING_TO_PICKUP)
        if self.state is ErrandState.PICKING_UP:
            if now - self._since >= self._settings.pickup_seconds:
                return self._go(now, ErrandState.GOING_TO_DROPOFF)
            return None
        if self.state in (ErrandState.DELIVERED, ErrandState.FAILED):
            return None
        return self._drive(now, event)

    @property
    def place(self) -> Place:
        """The place that the robot is at or on its way to."""
        towards_dropoff = self.state in (ErrandState.GOING_TO_DROPOFF, ErrandState.DELIVERED)
        return self._dropoff if towards_dropoff else self._pickup

    def _drive(self, now: float, event: Optional[Event]) -> Optional[Order]:
        if isinstance(event, GoalReached):
            return self._arrive(now)
        if isinstance(event, GoalRefused):
            return self._give_up_or_retry(now, event.reason)
        if self._retry_at is not None:
            return self._go(now, self.state) if now >= self._retry_at else None
        if now - self._since > self._settings.goal_timeout:
            return self._give_up_or_retry(now, f"not reached within {self._settings.goal_timeout:g} s")
        return None

    def _go(self, now: float, state: ErrandState) -> GoTo:
        if state is not self.state:
            self._attempt = 0
        self.state = state
        self._attempt += 1
        self._since = now
        self._retry_at = None
        return GoTo(self.place, self._attempt)

    def _arrive(self, now: float) -> Optional[Order]:
        self._since = now
        self._retry_at = None
        if self.state is ErrandState.GOING_TO_PICKUP:
            self.state = ErrandState.PICKING_UP
            return None
        self.state = ErrandState.DELIVERED
        return Finish(True, f"delivered at place {self._dropoff.name}")

    def _give_up_or_retry(self, now: float, reason: str) -> Optional[Order]:
        if self._attempt < self._settings.attempts:
            self._retry_at = now + self._settings.retry_seconds
            return None
        place = self.place
        self.state = ErrandState.FAILED
        tries = "1 attempt" if self._attempt == 1 else f"{self._attempt} attempts"
        return Finish(False, f"place {place.name} not reached after {tries}: {reason}")
