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
# Displacement below which a marker or goal counts as unchanged, and above which a step of the robot counts
# as a teleport [m].
SAME_PLACE_DISTANCE = 0.1
JUMP_DISTANCE = 0.5
# Distance from a goal within which a project may cancel it as reached [m].
CANCELLED_GOAL_TOLERANCE = 0.5


@dataclass
class ProjectGoal:
    """A navigation goal and how it ended; an entry of ``goals`` in result.json.

    Attributes:
        status: Name of the actionlib status.
        text: Status text of the action server.
        place: x, y in the frame of the goal [m]; None if the goal message was not received.
        sent: Simulated time at which it was sent [s].
        ended: Simulated time at which it ended [s].
        distance: True distance between robot and goal at that time [m].
    """

    status: str = "pending"
    text: str = ""
    place: Optional[Tuple[float, float]] = None
    sent: float = 0.0
    ended: Optional[float] = None
    distance: Optional[float] = None

    @property
    def is_reached(self) -> bool:
        """Whether it succeeded, or was cancelled while the robot was there."""
        is_near = self.distance is not None and self.distance < CANCELLED_GOAL_TOLERANCE
        return self.status == "succeeded" or (self.status == "preempted" and is_near)


@dataclass
class _PlaceVisit:
    """Consecutive goals at one position."""

    goals: List[ProjectGoal]

    @property
    def tries(self) -> int:
        """Number of goals until the position was reached; 0 if it was not."""
        return next((number for number, goal in enumerate(self.goals, 1) if goal.is_reached), 0)

    @property
    def is_reached(self) -> bool:
        return self.tries > 0


@dataclass
class ProjectRunRecord:
    """Goals, markers, collisions and distance of a run, by simulated time.

    Methods that update it return a description of the event, or None if nothing new happened. A marker event
    that repeats is not new until the next goal: some projects republish or blink markers forever.

    Attributes:
        goals: Goal id -> goal, in the order of sending.
        markers: Descriptions of marker events.
        collisions: Name of the body at each contact.
        distance_driven: Path length of the robot without teleports [m].
        last_event_time: Simulated time of the last goal or marker event [s].
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
        """Add a goal that was sent."""
        self._goal(now, name).place = place

    def update_status(self, now: float, name: str, number: int, text: str) -> Optional[str]:
        """Update a goal by its actionlib status."""
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
        detail = f": {text}" if text and status not in ("active", "succeeded") else ""
        return f"goal {list(self.goals).index(name) + 1}{at_position(goal.place)} {status}{detail}"

    def update_marker(
        self, now: float, marker: Tuple[str, int], place: Optional[Tuple[float, float]]
    ) -> Optional[str]:
        """Update a marker, identified by namespace and id: shown at x, y [m], or hidden (None)."""
        before = self._shown.get(marker)
        if place is None:
            if before is None:
                return None
            del self._shown[marker]
            change = "hidden"
        elif before is not None and math.dist(before, place) < SAME_PLACE_DISTANCE:
            return None
        else:
            self._shown[marker] = place
            change = f"shown{at_position(place)}"
        x, y = place or before or (0.0, 0.0)
        event = (place is None, round(x / SAME_PLACE_DISTANCE), round(y / SAME_PLACE_DISTANCE))
        if event in self._reported_events:
            return None
        self._reported_events.add(event)
        self.last_event_time = now
        self.markers.append(change)
        return f"marker {change}"

    def delete_all_markers(self, now: float) -> Optional[str]:
        """Update all markers as hidden."""
        events = [self.update_marker(now, marker, None) for marker in list(self._shown)]
        return events[0] if events else None

    def update_position(self, position: Tuple[float, float]) -> None:
        """Update the true position of the robot [m]; teleports do not count as driven."""
        if self._position is not None:
            step = math.dist(self._position, position)
            self.distance_driven += step if step < JUMP_DISTANCE else 0.0
        self._position = position

    def add_collision(self, name: str) -> Optional[str]:
        """Add a contact of the robot with a body; only the first with each body is reported."""
        is_new = name not in self.collisions
        self.collisions.append(name)
        return f"collision with {name}" if is_new else None

    @property
    def all_goals_ended(self) -> bool:
        """Whether a goal has been sent and none is active."""
        return bool(self.goals) and all(goal.status in FINAL_STATUSES for goal in self.goals.values())

    @property
    def is_object_picked_up(self) -> bool:
        """Whether markers were shown and all are hidden: the object is picked up and not yet delivered."""
        return bool(self.markers) and not self._shown

    @property
    def goals_of_two_rounds(self) -> int:
        """Number of goals after which a sequence of positions was visited twice; 0 if none was.

        Consecutive goals at one position count as one visit; every visit until then must have been reached.
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
        """Entries of result.json."""
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
