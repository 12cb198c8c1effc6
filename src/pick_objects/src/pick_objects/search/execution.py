"""Execution of a search: drive to views, look, until the object is found or everything was looked at."""

from dataclasses import dataclass, replace
from typing import Optional, Tuple, Union

from pick_objects.approach import DriveToPlace, PlaceApproach, PlaceReached, PlaceUnreachable
from pick_objects.config import ErrandSettings
from pick_objects.search.area import REACH
from pick_objects.search.object_search import ObjectSearch
from planar import Pose2
from planar.driving import GoalFailed, GoalReached
from planar.maps.places import NamedPlace


@dataclass(frozen=True)
class LookForObject:
    """Order: report whether the detector sees an object from here.

    Attributes:
        name: Name of the object.
    """

    name: str


@dataclass(frozen=True)
class LookTaken:
    """Event: the result of a look.

    Attributes:
        base_in_map: Estimated pose of the robot.
        seen_at: Position (x, y) of the object in the map [m]; None if it was not detected.
        problem: Why there was no look; empty if there was one.
    """

    base_in_map: Pose2
    seen_at: Optional[Tuple[float, float]] = None
    problem: str = ""


@dataclass(frozen=True)
class ObjectFound:
    """The object was found.

    Attributes:
        furniture: Name of the furniture that it is on; empty if it is beside all.
        seen_at: Its position in the map [m].
        place: Where the robot can pick it up.
    """

    furniture: str
    seen_at: Tuple[float, float]
    place: NamedPlace

    @property
    def where(self) -> str:
        """Where it is, for people."""
        x, y = self.seen_at
        on = f"on {self.furniture}, " if self.furniture else ""
        return f"{on}at ({x:.2f}, {y:.2f})"


@dataclass(frozen=True)
class ObjectNotFound:
    """The search has ended without success.

    Attributes:
        reason: What was looked at, for people.
    """

    reason: str


Outcome = Union[None, DriveToPlace, LookForObject, ObjectFound, ObjectNotFound]
SearchEvent = Union[None, GoalReached, GoalFailed, LookTaken]


class SearchExecution:
    """Carries out a search.

    Args:
        search: The search.
        settings: Time-outs and pauses of drives.

    Attributes:
        approach: Approach of the current view; None before the first.
    """

    def __init__(self, search: ObjectSearch, settings: ErrandSettings):
        self._search, self._settings = search, replace(settings, attempts=1)
        self.approach: Optional[PlaceApproach] = None
        self._view, self._is_looking = -1, False

    def start(self, now: float, base_in_map: Pose2) -> Outcome:
        """Return the first drive, or that nothing can be seen.

        Args:
            now: Time [s].
            base_in_map: Estimated pose of the robot.
        """
        self._is_looking = False
        view = self._search.next_view(base_in_map)
        if view is None:
            return ObjectNotFound(self._reason())
        self._view = view
        name = f"view of {self._search.furniture_shown_by(view)}"
        self.approach = PlaceApproach(NamedPlace(name, self._search.area.views[view]), self._settings)
        return self.approach.start(now)

    def advance(self, now: float, event: SearchEvent, base_in_map: Pose2) -> Outcome:
        """Advance to the current time; return an order or the end, None while nothing changes.

        Args:
            now: Time [s].
            event: What happened to the last order, if there is news.
            base_in_map: Estimated pose of the robot.
        """
        assert self.approach is not None
        if self._is_looking:
            return self._evaluate(now, event) if isinstance(event, LookTaken) else None
        answer = self.approach.advance(now, None if isinstance(event, LookTaken) else event)
        if isinstance(answer, PlaceReached):
            self._is_looking = True
            return LookForObject(self._search.object_name)
        if isinstance(answer, PlaceUnreachable):
            self._search.on_unreachable(self._view)
            return self.start(now, base_in_map)
        return answer

    def _evaluate(self, now: float, look: LookTaken) -> Outcome:
        if look.problem:
            return ObjectNotFound(f"{self._search.object_name} cannot be searched: {look.problem}")
        if look.seen_at is None:
            self._search.on_nothing_seen(self._view)
            return self.start(now, look.base_in_map)
        area, name = self._search.area, self._search.object_name
        furniture = area.semantic_map.furniture_at(*look.seen_at)
        pose = area.pose_near(*look.seen_at, look.base_in_map)
        if pose is None:
            where = f" on {furniture}" if furniture else ""
            return ObjectNotFound(
                f"{name} was seen{where}, but the robot cannot come within {REACH:g} m of it"
            )
        return ObjectFound(furniture, look.seen_at, NamedPlace(name, pose))

    def _reason(self) -> str:
        search = self._search
        seen, unseen = search.names_looked_at()
        if not seen:
            return (
                f"{search.object_name} was not found: the robot cannot reach a place that shows any furniture"
            )
        looks = "1 look" if search.looks == 1 else f"{search.looks} looks"
        text = f"{search.object_name} was not found in {looks} at {', '.join(seen)}"
        return f"{text}; not seen: {', '.join(unseen)}" if unseen else text
