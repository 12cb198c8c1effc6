"""Record of what a project did: goals, markers, collisions and the distance driven."""

import math
from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Set, Tuple

STATUS_NAMES = (
    "pending",
    "active",
    "preempted",
    "succeeded",
    "aborted",
    "rejected",
    "preempting",
    "recalling",
    "recalled",
    "lost",
)
FINAL_STATUSES = frozenset(("preempted", "succeeded", "aborted", "rejected", "recalled", "lost"))
# Metres: a marker that moves by less stays; a robot that moves by more at once has been put there.
SAME_PLACE_DISTANCE = 0.1
JUMP_DISTANCE = 0.5
# Metres from a goal within which a project may call it reached, and cancel it, by its own measure.
CANCELLED_GOAL_TOLERANCE = 0.5


@dataclass
class ProjectGoal:
    """A goal, its place, how it ended, and how far from it the robot truly was then; metres, if known."""

    status: str = "pending"
    text: str = ""
    place: Optional[Tuple[float, float]] = None
    sent: float = 0.0
    ended: Optional[float] = None
    distance: Optional[float] = None

    @property
    def is_reached(self) -> bool:
        """Whether it succeeded, or was cancelled by who sent it when the robot was there."""
        is_near = self.distance is not None and self.distance < CANCELLED_GOAL_TOLERANCE
        return self.status == "succeeded" or (self.status == "preempted" and is_near)


@dataclass
class _PlaceVisit:
    """Goals at one place, one after the other."""

    goals: List[ProjectGoal]

    @property
    def tries(self) -> int:
        """How many goals it took to get there; 0 if the robot did not."""
        return next((number for number, goal in enumerate(self.goals, 1) if goal.is_reached), 0)

    @property
    def is_reached(self) -> bool:
        return self.tries > 0


@dataclass
class ProjectRunRecord:
    """What has been seen of a run, by simulated time. Each ``see`` returns the news in words, or None.

    What markers do once more is no news, until a goal has been: some blink, or are shown anew, for ever.
    """

    goals: Dict[str, ProjectGoal] = field(default_factory=dict)
    markers: List[str] = field(default_factory=list)
    collisions: List[str] = field(default_factory=list)
    distance_driven: float = 0.0
    last_event_time: float = 0.0
    _position: Optional[Tuple[float, float]] = None
    _shown: Dict[Tuple[str, int], Tuple[float, float]] = field(default_factory=dict)
    _reported_events: Set[Tuple[bool, int, int]] = field(default_factory=set)

    def add_goal(self, now: float, name: str, place: Tuple[float, float]) -> None:
        """A goal was sent."""
        self._goal(now, name).place = place

    def update_status(self, now: float, name: str, number: int, text: str) -> Optional[str]:
        """The server said how a goal stands."""
        goal = self._goal(now, name)
        status = STATUS_NAMES[number] if 0 <= number < len(STATUS_NAMES) else "lost"
        if status == goal.status or goal.status in FINAL_STATUSES:
            return None
        goal.status, goal.text = status, text
        self._on_goal_event(now)
        if status in FINAL_STATUSES:
            goal.ended = now
            if goal.place and self._position:
                goal.distance = round(math.dist(goal.place, self._position), 3)
        said = f": {text}" if text and status not in ("active", "succeeded") else ""
        return f"goal {list(self.goals).index(name) + 1}{at_position(goal.place)} {status}{said}"

    def update_marker(
        self, now: float, marker: Tuple[str, int], place: Optional[Tuple[float, float]]
    ) -> Optional[str]:
        """A marker was shown at a place, or hidden (None)."""
        before = self._shown.get(marker)
        if place is None:
            if before is None:
                return None
            del self._shown[marker]
            news = "hidden"
        elif before is not None and math.dist(before, place) < SAME_PLACE_DISTANCE:
            return None
        else:
            self._shown[marker] = place
            news = f"shown{at_position(place)}"
        x, y = place or before or (0.0, 0.0)
        event = (place is None, round(x / SAME_PLACE_DISTANCE), round(y / SAME_PLACE_DISTANCE))
        if event in self._reported_events:
            return None
        self._reported_events.add(event)
        self.last_event_time = now
        self.markers.append(news)
        return f"marker {news}"

    def delete_all_markers(self, now: float) -> Optional[str]:
        """All markers were deleted."""
        news = [self.update_marker(now, marker, None) for marker in list(self._shown)]
        return news[0] if news else None

    def update_position(self, position: Tuple[float, float]) -> None:
        """Where the robot truly is; a jump, as by a service of the simulator, is not driven."""
        if self._position is not None:
            step = math.dist(self._position, position)
            self.distance_driven += step if step < JUMP_DISTANCE else 0.0
        self._position = position

    def add_collision(self, name: str) -> Optional[str]:
        """The robot touches something; that it does so again is no news."""
        is_news = name not in self.collisions
        self.collisions.append(name)
        return f"collision with {name}" if is_news else None

    @property
    def all_goals_ended(self) -> bool:
        """Whether a goal has been sent and none is under way."""
        return bool(self.goals) and all(goal.status in FINAL_STATUSES for goal in self.goals.values())

    @property
    def is_object_picked_up(self) -> bool:
        """Whether markers have been shown and none is now: what was picked up is still to be set down."""
        return bool(self.markers) and not self._shown

    @property
    def goals_of_two_rounds(self) -> int:
        """The number of goals after which it had been through some places twice; 0 if it has not.

        Goals at one place in a row count as one, and none may have been in vain until then.
        """
        visits = _visits(list(self.goals.values()))
        for end, visit in enumerate(visits, 1):
            if not visit.is_reached:
                return 0
            for length in range(2, end // 2 + 1):
                first, second = visits[end - 2 * length : end - length], visits[end - length : end]
                if all(is_same_place(a.goals[0], b.goals[0]) for a, b in zip(first, second)):
                    return sum(len(earlier.goals) for earlier in visits[: end - 1]) + visit.tries
        return 0

    def findings(self) -> Dict[str, Any]:
        """What belongs into result.json."""
        return {
            "goals": [vars(goal) for goal in self.goals.values()],
            "markers": self.markers,
            "distance_driven": round(self.distance_driven, 2),
            "collisions": self.collisions,
        }

    def _goal(self, now: float, name: str) -> ProjectGoal:
        if name not in self.goals:
            self.goals[name] = ProjectGoal(sent=now)
            self._on_goal_event(now)
        return self.goals[name]

    def _on_goal_event(self, now: float) -> None:
        self.last_event_time = now
        self._reported_events.clear()


def _visits(goals: List[ProjectGoal]) -> List[_PlaceVisit]:
    visits: List[_PlaceVisit] = []
    for goal in goals:
        if visits and is_same_place(visits[-1].goals[0], goal):
            visits[-1].goals.append(goal)
        else:
            visits.append(_PlaceVisit([goal]))
    return visits


def is_same_place(goal: ProjectGoal, other: ProjectGoal) -> bool:
    if goal.place is None or other.place is None:
        return False
    return math.dist(goal.place, other.place) < SAME_PLACE_DISTANCE


def at_position(place: Optional[Tuple[float, float]]) -> str:
    return "" if place is None else f" at ({place[0]:.2f}, {place[1]:.2f})"
