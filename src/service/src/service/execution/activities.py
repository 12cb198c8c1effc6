"""What the robot is doing: driving, handling an object, standing, docking, undocking."""

from dataclasses import dataclass
from typing import Callable, Optional, Protocol, Union

from pick_objects import ErrandSettings, GoalFailed, GoalReached, LookTaken, RobotDisplaced
from pick_objects.approach import PlaceApproach, PlaceReached, PlaceUnreachable
from pick_objects.search import ObjectFound, ObjectNotFound, ObjectSearch, SearchExecution
from pick_objects.search.execution import Outcome as SearchOutcome
from planar import Pose2
from planar.maps.places import NamedPlace
from service.config import ServiceSettings
from service.execution.robot import (
    DockingFailed,
    DockRobot,
    RobotDocked,
    RobotEvent,
    RobotOrder,
    RobotUndocked,
    UndockRobot,
)


@dataclass(frozen=True)
class ActivityDone:
    """The activity has ended as intended."""


@dataclass(frozen=True)
class ActivityFailed:
    """The activity has failed.

    Attributes:
        reason: Explanation for people.
    """

    reason: str


@dataclass(frozen=True)
class ActivityDisplaced:
    """The robot is no longer where the activity takes place."""


Outcome = Union[None, ActivityDone, ActivityFailed, ActivityDisplaced, RobotOrder]


class Activity(Protocol):
    """What the robot does; ``now`` is elapsed time [s].

    Attributes:
        text: Present participle for people: ``driving to kitchen``.
        is_interruptible: Whether a more urgent task may take its place.
        wakes_at: Elapsed time at which it has to be advanced without an event [s]; None: only with one.
    """

    text: str
    is_interruptible: bool

    @property
    def wakes_at(self) -> Optional[float]: ...

    def start(self, now: float) -> Optional[RobotOrder]:
        """Return the first order."""

    def advance(self, now: float, event: Optional[RobotEvent]) -> Outcome:
        """Return its end, or a further order; None while nothing changes."""


class Driving:
    """Drives to a place."""

    is_interruptible = True

    def __init__(self, place: NamedPlace, settings: ServiceSettings):
        self.text = f"driving to {place.name}"
        self._approach = PlaceApproach(place, _errand_settings(settings))
        self._poll = settings.retry_seconds
        self._now = 0.0

    @property
    def wakes_at(self) -> Optional[float]:
        return self._now + max(self._poll, 1.0)

    def start(self, now: float) -> Optional[RobotOrder]:
        self._now = now
        return self._approach.start(now)

    def advance(self, now: float, event: Optional[RobotEvent]) -> Outcome:
        self._now = now
        is_drive = isinstance(event, (GoalReached, GoalFailed))
        answer = self._approach.advance(now, event if is_drive else None)  # type: ignore[arg-type]
        if isinstance(answer, PlaceReached):
            return ActivityDone()
        if isinstance(answer, PlaceUnreachable):
            return ActivityFailed(answer.reason)
        return answer


class Searching:
    """Searches an object.

    Args:
        search: The search.
        settings: Durations and patience.
        locate: Returns the estimated pose of the robot in the map.

    Attributes:
        found: Where it was found; None before.
    """

    is_interruptible = True

    def __init__(self, search: ObjectSearch, settings: ServiceSettings, locate: Callable[[], Pose2]):
        self.text = f"searching {search.object_name}"
        self.found: Optional[ObjectFound] = None
        self._name, self._locate, self._poll = search.object_name, locate, settings.retry_seconds
        self._execution = SearchExecution(search, _errand_settings(settings))
        self._end: Optional[ActivityFailed] = None
        self._now = 0.0

    @property
    def wakes_at(self) -> Optional[float]:
        return self._now + max(self._poll, 1.0)

    def start(self, now: float) -> Optional[RobotOrder]:
        self._now = now
        outcome = self._outcome(self._execution.start(now, self._locate()))
        if isinstance(outcome, ActivityFailed):
            self._end = outcome
            return None
        return outcome  # type: ignore[return-value]

    def advance(self, now: float, event: Optional[RobotEvent]) -> Outcome:
        self._now = now
        if self._end is not None:
            return self._end
        is_of_search = isinstance(event, (GoalReached, GoalFailed, LookTaken))
        news = event if is_of_search else None
        return self._outcome(self._execution.advance(now, news, self._locate()))  # type: ignore[arg-type]

    def _outcome(self, outcome: SearchOutcome) -> Outcome:
        if isinstance(outcome, ObjectNotFound):
            return ActivityFailed(outcome.reason)
        if isinstance(outcome, ObjectFound):
            self.found = outcome
            return ActivityDone()
        if self._execution.approach is not None:
            self.text = f"searching {self._name}: {self._execution.approach.place.name}"
        return outcome


def _errand_settings(settings: ServiceSettings) -> ErrandSettings:
    return ErrandSettings(
        goal_timeout=settings.goal_timeout,
        attempts=settings.attempts,
        retry_seconds=settings.retry_seconds,
    )


class Standing:
    """Stands for a time: to pick up, to set down, or to wait.

    Args:
        text: What is done meanwhile.
        seconds: Duration [s].
        is_interruptible: Whether a more urgent task may take its place.
    """

    def __init__(self, text: str, seconds: float, is_interruptible: bool = False):
        self.text, self.is_interruptible = text, is_interruptible
        self._seconds, self._until = seconds, 0.0

    @property
    def wakes_at(self) -> Optional[float]:
        return self._until

    def start(self, now: float) -> Optional[RobotOrder]:
        self._until = now + self._seconds
        return None

    def advance(self, now: float, event: Optional[RobotEvent]) -> Outcome:
        if isinstance(event, RobotDisplaced):
            return ActivityDisplaced()
        return ActivityDone() if now >= self._until else None


class _RetriedOrder:
    """Sends an order to dock or undock, again after a pause if it fails.

    Args:
        order: The order.
        success: Type of the event that ends it.
        achievement: What the robot is then, for messages.
        pause: Time before another attempt [s].
        attempts: Number of attempts; None: until it succeeds.
    """

    def __init__(
        self, order: RobotOrder, success: type, achievement: str, pause: float, attempts: Optional[int]
    ):
        self._order, self._success, self._achievement = order, success, achievement
        self._pause, self._left = pause, attempts
        self._retry_at: Optional[float] = None

    @property
    def wakes_at(self) -> Optional[float]:
        return self._retry_at

    def start(self, now: float) -> Optional[RobotOrder]:
        self._retry_at = None
        return self._order

    def advance(self, now: float, event: Optional[RobotEvent]) -> Outcome:
        if isinstance(event, self._success):
            return ActivityDone()
        if isinstance(event, DockingFailed):
            self._left = None if self._left is None else self._left - 1
            if self._left == 0:
                return ActivityFailed(f"not {self._achievement}: {event.reason}")
            self._retry_at = now + self._pause
        return self.start(now) if self._retry_at is not None and now >= self._retry_at else None


class DockingActivity(_RetriedOrder):
    """Drives into the dock.

    Args:
        settings: The pause before another attempt.
        attempts: Number of attempts; None: until it succeeds.
    """

    is_interruptible = True
    text = "docking"

    def __init__(self, settings: ServiceSettings, attempts: Optional[int] = None):
        super().__init__(DockRobot(), RobotDocked, "docked", settings.dock_retry_seconds, attempts)

    def advance(self, now: float, event: Optional[RobotEvent]) -> Outcome:
        outcome = super().advance(now, event)
        if isinstance(event, DockingFailed) and not isinstance(outcome, ActivityFailed):
            self.text = f"docking again after: {event.reason}"
        return outcome


class UndockingActivity(_RetriedOrder):
    """Leaves the dock, then goes on with another activity.

    Args:
        following: What is done next.
        settings: The pause before another attempt, and the number of attempts.
    """

    is_interruptible = False
    text = "undocking"

    def __init__(self, following: Activity, settings: ServiceSettings):
        pause, attempts = settings.dock_retry_seconds, settings.attempts
        super().__init__(UndockRobot(), RobotUndocked, "undocked", pause, attempts)
        self.following = following
