"""Drive to one place: its poses in turn, with time-outs and pauses, until it is reached or given up."""

from dataclasses import dataclass
from typing import Optional, Union

from pick_objects.config import ErrandSettings
from planar import Pose2
from planar.driving import GoalFailed, GoalReached
from planar.maps.places import NamedPlace


@dataclass(frozen=True)
class DriveToPlace:
    """Order: drive to a place. It replaces any earlier order.

    Attributes:
        place: Where to drive.
        attempt: Number of the attempt, from 1.
    """

    place: NamedPlace
    attempt: int

    @property
    def pose(self) -> Pose2:
        """Goal pose of this attempt: the poses of a place are tried in turn."""
        return self.place.poses[(self.attempt - 1) % len(self.place.poses)]


@dataclass(frozen=True)
class PlaceReached:
    """The robot is at the place."""


@dataclass(frozen=True)
class PlaceUnreachable:
    """The place was given up.

    Attributes:
        reason: Why the last attempt failed.
    """

    reason: str


class PlaceApproach:
    """Sends the robot to a place until it arrives or has used up its attempts.

    Args:
        place: Where to drive.
        settings: Attempts, pauses and the default time-out.
        goal_timeout: Time after which an attempt has failed [s]; None: that of the settings.
    """

    def __init__(self, place: NamedPlace, settings: ErrandSettings, goal_timeout: Optional[float] = None):
        self.place = place
        self.attempt = 0
        self._settings = settings
        self._timeout = settings.goal_timeout if goal_timeout is None else goal_timeout
        self._started_at = self._sent_at = 0.0
        self._retry_at: Optional[float] = None
        self._is_preempted = False

    def start(self, now: float) -> DriveToPlace:
        """Begin the next attempt, or repeat the current one if another client took the robot over."""
        if not self._is_preempted:
            self.attempt += 1
            self._started_at = now
        self._sent_at = now
        self._retry_at = None
        self._is_preempted = False
        return DriveToPlace(self.place, self.attempt)

    def advance(
        self, now: float, event: Union[None, GoalReached, GoalFailed]
    ) -> Union[None, DriveToPlace, PlaceReached, PlaceUnreachable]:
        """Advance to the current time.

        Args:
            now: Time [s].
            event: Outcome of the last goal, if there is a new one.

        Returns:
            The next goal, the end of the approach, or None while nothing changes.
        """
        if isinstance(event, GoalReached):
            return PlaceReached()
        if isinstance(event, GoalFailed):
            if event.is_preempted and 0.0 <= now - self._started_at <= self._timeout:
                self._is_preempted, self._retry_at = True, now + self._settings.retry_seconds
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
