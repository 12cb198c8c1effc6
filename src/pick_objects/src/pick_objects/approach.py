"""One drive to a place: its poses in turn, with time-outs and pauses, until it is reached or given up."""

from dataclasses import dataclass
from typing import Optional, Union

from pick_objects.config import ErrandSettings
from planar import Pose2
from planar.driving import GoalFailed, GoalReached
from planar.maps.places import NamedPlace


@dataclass(frozen=True)
class DriveToPlace:
    """Order: drive to this place. It takes the place of any earlier order."""

    place: NamedPlace
    attempt: int

    @property
    def pose(self) -> Pose2:
        """The one of the place's poses whose turn it is."""
        return self.place.poses[(self.attempt - 1) % len(self.place.poses)]


@dataclass(frozen=True)
class PlaceReached:
    """The place is reached."""


@dataclass(frozen=True)
class PlaceUnreachable:
    """The place cannot be reached, and why."""

    reason: str


class PlaceApproach:
    """Answers, told the time and what came of the last goal, what to do to get to ``place``."""

    def __init__(self, place: NamedPlace, settings: ErrandSettings, goal_timeout: Optional[float] = None):
        self.place = place
        self.attempt = 0
        self._settings = settings
        self._timeout = settings.goal_timeout if goal_timeout is None else goal_timeout
        self._begun_at = self._sent_at = 0.0
        self._retry_at: Optional[float] = None
        self._is_taken_over = False

    def start(self, now: float) -> DriveToPlace:
        """The next attempt, or the same once more if others took the robot for themselves."""
        if not self._is_taken_over:
            self.attempt += 1
            self._begun_at = now
        self._sent_at = now
        self._retry_at = None
        self._is_taken_over = False
        return DriveToPlace(self.place, self.attempt)

    def advance(
        self, now: float, event: Union[None, GoalReached, GoalFailed]
    ) -> Union[None, DriveToPlace, PlaceReached, PlaceUnreachable]:
        """What has come of it, the next goal, or None to carry on. ``now``: seconds."""
        if isinstance(event, GoalReached):
            return PlaceReached()
        if isinstance(event, GoalFailed):
            if event.is_preempted and 0.0 <= now - self._begun_at <= self._timeout:
                self._is_taken_over, self._retry_at = True, now + self._settings.retry_seconds
                return None
            return self._give_up_or_pause(now, event.reason)
        if self._retry_at is not None:
            return self.start(now) if now >= self._retry_at else None
        if now - self._sent_at > self._timeout:
            return self._give_up_or_pause(now, f"not reached within {self._timeout:g} s")
        return None

    def _give_up_or_pause(self, now: float, reason: str) -> Optional[PlaceUnreachable]:
        if self.attempt < self._settings.attempts:
            self._retry_at = now + self._settings.retry_seconds
            return None
        tries = "1 attempt" if self.attempt == 1 else f"{self.attempt} attempts"
        return PlaceUnreachable(f"place {self.place.name} not reached after {tries}: {reason}")
