"""What a project did, and whether that was what it set out to do."""

import math
from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Sequence, Set, Tuple

STATUS = (
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
FINAL = frozenset(("preempted", "succeeded", "aborted", "rejected", "recalled", "lost"))
# Metres: a marker that moves by less stays; a robot that moves by more at once has been put there.
SAME_PLACE = 0.1
JUMP = 0.5
# Metres from a goal within which a project may call it reached, and cancel it, by its own measure.
NEAR = 0.5
MOST_TOLD = 8


@dataclass
class Goal:
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
        is_near = self.distance is not None and self.distance < NEAR
        return self.status == "succeeded" or (self.status == "preempted" and is_near)


@dataclass
class _Visit:
    """Goals at one place, one after the other."""

    goals: List[Goal]

    @property
    def tries(self) -> int:
        """How many goals it took to get there; 0 if the robot did not."""
        return next((number for number, goal in enumerate(self.goals, 1) if goal.is_reached), 0)

    @property
    def is_reached(self) -> bool:
        return self.tries > 0


@dataclass
class Ledger:
    """What has been seen of a run, by simulated time. Each ``see`` returns the news in words, or None.

    What markers do once more is no news, until a goal has been: some blink, or are shown anew, for ever.
    """

    goals: Dict[str, Goal] = field(default_factory=dict)
    markers: List[str] = field(default_factory=list)
    collisions: List[str] = field(default_factory=list)
    distance_driven: float = 0.0
    latest_news: float = 0.0
    _position: Optional[Tuple[float, float]] = None
    _shown: Dict[Tuple[str, int], Tuple[float, float]] = field(default_factory=dict)
    _told: Set[Tuple[bool, int, int]] = field(default_factory=set)

    def see_goal(self, now: float, name: str, place: Tuple[float, float]) -> None:
        """A goal was sent."""
        self._goal(now, name).place = place

    def see_status(self, now: float, name: str, number: int, text: str) -> Optional[str]:
        """The server said how a goal stands."""
        goal = self._goal(now, name)
        status = STATUS[number] if 0 <= number < len(STATUS) else "lost"
        if status == goal.status or goal.status in FINAL:
            return None
        goal.status, goal.text = status, text
        self._note_goal(now)
        if status in FINAL:
            goal.ended = now
            if goal.place and self._position:
                goal.distance = round(math.dist(goal.place, self._position), 3)
        said = f": {text}" if text and status not in ("active", "succeeded") else ""
        return f"goal {list(self.goals).index(name) + 1}{_at(goal.place)} {status}{said}"

    def see_marker(
        self, now: float, marker: Tuple[str, int], place: Optional[Tuple[float, float]]
    ) -> Optional[str]:
        """A marker was shown at a place, or hidden (None)."""
        before = self._shown.get(marker)
        if place is None:
            if before is None:
                return None
            del self._shown[marker]
            news = "hidden"
        elif before is not None and math.dist(before, place) < SAME_PLACE:
            return None
        else:
            self._shown[marker] = place
            news = f"shown{_at(place)}"
        x, y = place or before or (0.0, 0.0)
        event = (place is None, round(x / SAME_PLACE), round(y / SAME_PLACE))
        if event in self._told:
            return None
        self._told.add(event)
        self.latest_news = now
        self.markers.append(news)
        return f"marker {news}"

    def hide_all(self, now: float) -> Optional[str]:
        """All markers were deleted."""
        news = [self.see_marker(now, marker, None) for marker in list(self._shown)]
        return news[0] if news else None

    def see_position(self, position: Tuple[float, float]) -> None:
        """Where the robot truly is; a jump, as by a service of the simulator, is not driven."""
        if self._position is not None:
            step = math.dist(self._position, position)
            self.distance_driven += step if step < JUMP else 0.0
        self._position = position

    def see_collision(self, name: str) -> Optional[str]:
        """The robot touches something; that it does so again is no news."""
        is_news = name not in self.collisions
        self.collisions.append(name)
        return f"collision with {name}" if is_news else None

    @property
    def is_quiet(self) -> bool:
        """Whether a goal has been sent and none is under way."""
        return bool(self.goals) and all(goal.status in FINAL for goal in self.goals.values())

    @property
    def is_object_away(self) -> bool:
        """Whether markers have been shown and none is now: what was picked up is still to be set down."""
        return bool(self.markers) and not self._shown

    @property
    def two_rounds(self) -> int:
        """The number of goals after which it had been through some places twice; 0 if it has not.

        Goals at one place in a row count as one, and none may have been in vain until then.
        """
        visits = _visits(list(self.goals.values()))
        for end, visit in enumerate(visits, 1):
            if not visit.is_reached:
                return 0
            for length in range(2, end // 2 + 1):
                first, second = visits[end - 2 * length : end - length], visits[end - length : end]
                if all(_is_same_place(a.goals[0], b.goals[0]) for a, b in zip(first, second)):
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

    def _goal(self, now: float, name: str) -> Goal:
        if name not in self.goals:
            self.goals[name] = Goal(sent=now)
            self._note_goal(now)
        return self.goals[name]

    def _note_goal(self, now: float) -> None:
        self.latest_news = now
        self._told.clear()


@dataclass(frozen=True)
class Verdict:
    """Whether a run succeeded, and why."""

    success: bool
    reason: str


def judge(
    ledger: Ledger,
    failure: Optional[str] = None,
    is_errand: bool = False,
    expected: Optional[Sequence[str]] = None,
) -> Verdict:
    """Success if the robot reached all places it was sent to; without goals, if the project showed a marker.

    A goal that failed and was sent again does not count, nor do those of a third round of the same places.
    ``failure``: why the run was cut short, if it was. ``is_errand``: markers alone are not enough.
    ``expected``: how the goals have to end instead, one after the other.
    """
    goals = list(ledger.goals.values())[: ledger.two_rounds or None]
    reached = sum(goal.is_reached for goal in goals)
    failed = [
        f"goal {number}{_at(goal.place)} {goal.status}{f' ({goal.text})' if goal.text else ''}"
        for number, goal in enumerate(goals, 1)
        if not goal.is_reached and not _was_reached_later(goal, goals[number:])
    ]
    if failure:
        return Verdict(False, f"{failure}; {reached} of {len(goals)} goals reached")
    if expected is not None:
        endings = [goal.status for goal in goals]
        is_so = endings == list(expected)
        said = "as expected" if is_so else f"instead of {', '.join(expected)}"
        story = f"{', '.join(endings) or 'none'}, {said}"
        return Verdict(is_so, f"{reached} of {len(goals)} goals reached; {story}")
    if failed:
        return Verdict(False, f"{reached} of {len(goals)} goals reached; {'; '.join(failed)}")
    story = f"markers: {', '.join(_shortened(ledger.markers))}" if ledger.markers else "no marker shown"
    if goals:
        return Verdict(True, f"{reached} of {len(goals)} goals reached; {story}")
    return Verdict(bool(ledger.markers) and not is_errand, f"no goal sent; {story}")


def _shortened(events: List[str]) -> List[str]:
    """Without the middle, where a marker went with the robot."""
    if len(events) <= MOST_TOLD:
        return events
    half = MOST_TOLD // 2
    return [*events[:half], f"... {len(events) - MOST_TOLD} more ...", *events[-half:]]


def _was_reached_later(goal: Goal, later: List[Goal]) -> bool:
    return any(other.is_reached and _is_same_place(goal, other) for other in later)


def _visits(goals: List[Goal]) -> List[_Visit]:
    visits: List[_Visit] = []
    for goal in goals:
        if visits and _is_same_place(visits[-1].goals[0], goal):
            visits[-1].goals.append(goal)
        else:
            visits.append(_Visit([goal]))
    return visits


def _is_same_place(goal: Goal, other: Goal) -> bool:
    if goal.place is None or other.place is None:
        return False
    return math.dist(goal.place, other.place) < SAME_PLACE


def _at(place: Optional[Tuple[float, float]]) -> str:
    return "" if place is None else f" at ({place[0]:.2f}, {place[1]:.2f})"
