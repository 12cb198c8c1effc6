"""Record of what a project did: goals, markers, collisions and the distance driven."""

import math
from dataclasses import dataclass, field
from typing import Any, Callable, Dict, List, Optional, Set, Tuple

from evaluation.event_stream import EventStream
from evaluation.events import (
    DELETE_ALL,
    SHOW,
    BodiesTouched,
    ClockAdvanced,
    EstimateUpdated,
    GoalAccepted,
    GoalEnded,
    GoalRequested,
    GoalStatusUpdated,
    MarkerUpdated,
    TruthUpdated,
)
from planar import Pose2
from run_project.judging.map_alignment import MapAlignment

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
# Displacement between two poses of a robot that drives [m].
LEAST_STEP = 1e-4
# Time without events and motion after which a project is not busy any more [s].
REST_SECONDS = 30.0
# Distance from a goal within which a project may cancel it as reached [m].
CANCELLED_GOAL_TOLERANCE = 0.5


@dataclass
class ProjectGoal:
    """A navigation goal and how it ended; an entry of ``goals`` in result.json.

    Attributes:
        status: Name of the actionlib status.
        text: Status text of the action server.
        place: x, y in the frame of the goal, or of the map if the goal message was not received [m]; None if
            navigation has not reported it either.
        sent: Simulated time at which it was sent [s].
        ended: Simulated time at which it ended [s].
        distance: True distance between robot and goal at that time, in the frame of the map [m].
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
    """Goals, markers, collisions and distance of a run, by simulated time. It consumes run events.

    A marker event that repeats is not logged until the next goal: some projects republish or blink markers
    forever.

    Attributes:
        log: Called with each event that is new, in words.
        goals: Goal id -> goal, in the order of sending.
        markers: Descriptions of marker events.
        collisions: Name of the body at each contact.
        pace_rules: How simulated time passes beside each node of the project, in words.
        distance_driven: Path length of the robot without teleports [m].
        simulated_time: Current time [s].
        last_event_time: Simulated time of the last goal or marker event [s].
        last_motion_time: Simulated time at which the robot last moved [s].
        alignment: Where the frame of the goals lies in the world.
    """

    log: Callable[[str], None]
    goals: Dict[str, ProjectGoal] = field(default_factory=dict)
    markers: List[str] = field(default_factory=list)
    collisions: List[str] = field(default_factory=list)
    pace_rules: List[str] = field(default_factory=list)
    distance_driven: float = 0.0
    simulated_time: float = 0.0
    last_event_time: float = 0.0
    last_motion_time: float = 0.0
    alignment: MapAlignment = field(default_factory=MapAlignment)
    _base: Optional[Pose2] = None
    _ended_at: Dict[str, Pose2] = field(default_factory=dict)
    _accepted: Optional[Tuple[float, float]] = None  # place of a goal of which nothing else is known yet
    _unlogged: Set[str] = field(default_factory=set)
    _shown: Dict[Tuple[str, int], Tuple[float, float]] = field(default_factory=dict)
    _reported_events: Set[Tuple[bool, int, int]] = field(default_factory=set)

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(ClockAdvanced, self._on_clock)
        events.subscribe(TruthUpdated, self._on_truth)
        events.subscribe(EstimateUpdated, self._on_estimate)
        events.subscribe(BodiesTouched, self._on_contact)
        events.subscribe(GoalRequested, self._on_goal)
        events.subscribe(GoalAccepted, self._on_accepted)
        events.subscribe(GoalStatusUpdated, self._on_status)
        events.subscribe(GoalEnded, self._on_status)
        events.subscribe(MarkerUpdated, self._on_marker)

    @property
    def all_goals_ended(self) -> bool:
        """Whether a goal has been sent and none is active."""
        return bool(self.goals) and all(goal.status in FINAL_STATUSES for goal in self.goals.values())

    @property
    def is_object_picked_up(self) -> bool:
        """Whether markers were shown and all are hidden: the object is picked up and not yet delivered."""
        return bool(self.markers) and not self._shown

    @property
    def is_object_delivered(self) -> bool:
        """Whether a marker was hidden and is shown again, and the last goal was reached."""
        last_goal = next(reversed(list(self.goals.values())), None)
        is_shown_again = bool(self._shown) and "hidden" in self.markers
        return is_shown_again and last_goal is not None and last_goal.is_reached

    @property
    def is_busy(self) -> bool:
        """Whether the robot has moved, or goals or markers have changed, a short time ago."""
        return self.simulated_time - max(self.last_motion_time, self.last_event_time) < REST_SECONDS

    @property
    def is_object_never_moved(self) -> bool:
        """Whether markers were shown, and each stays where it was shown first."""
        return bool(self.markers) and len(self.markers) == len(self._shown)

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

    def measure_distances(self) -> None:
        """Determine the distances of the goals with what is known of the map's frame by now."""
        frame = self.alignment.map_in_world()
        for name, base in self._ended_at.items():
            goal = self.goals[name]
            if goal.place is not None:
                goal.distance = round((frame @ Pose2(*goal.place)).distance_to(base), 3)

    def findings(self) -> Dict[str, Any]:
        """Entries of result.json."""
        frame = self.alignment.map_in_world()
        return {
            "map_in_world": [round(value, 3) for value in (frame.x, frame.y, frame.yaw)],
            "goals": [vars(goal) for goal in self.goals.values()],
            "markers": self.markers,
            "distance_driven": round(self.distance_driven, 2),
            "collisions": self.collisions,
            "pace": self.pace_rules,
        }

    def _on_clock(self, event: ClockAdvanced) -> None:
        self.simulated_time = event.stamp

    def _on_truth(self, event: TruthUpdated) -> None:
        """Update the true position; teleports do not count as driven."""
        if self._base is not None:
            step = self._base.distance_to(event.pose)
            self.distance_driven += step if step < JUMP_DISTANCE else 0.0
            self.last_motion_time = self.simulated_time if step > LEAST_STEP else self.last_motion_time
        self._base = event.pose

    def _on_estimate(self, event: EstimateUpdated) -> None:
        if self._base is not None:
            self.alignment.add(event.pose, self._base)

    def _on_contact(self, event: BodiesTouched) -> None:
        """Add contacts; only the first with each body is logged."""
        for name in event.names:
            is_new = name not in self.collisions
            self.collisions.append(name)
            if is_new:
                self.log(f"collision with {name}")

    def _on_goal(self, event: GoalRequested) -> None:
        self._goal(event.identity)
        self._accepted = None
        self._set_place(event.identity, (event.pose.x, event.pose.y))

    def _on_accepted(self, event: GoalAccepted) -> None:
        """Take the place of a goal whose message was not received: its sender was connected too late."""
        self._accepted = (event.pose.x, event.pose.y)
        latest = next(reversed(list(self.goals)), None)
        if latest is not None and self.goals[latest].status not in FINAL_STATUSES:
            self._take_accepted_place(latest)

    def _take_accepted_place(self, name: str) -> None:
        if self._accepted is not None and self.goals[name].place is None:
            self._set_place(name, self._accepted)
        self._accepted = None

    def _set_place(self, name: str, place: Tuple[float, float]) -> None:
        self.goals[name].place = place
        if name in self._unlogged:
            self._log_status(name, self.goals[name])

    def _on_status(self, event: GoalStatusUpdated) -> None:
        is_new = event.identity not in self.goals
        goal = self._goal(event.identity)
        if is_new:
            self._take_accepted_place(event.identity)
        status = STATUS_NAMES[event.status] if 0 <= event.status < len(STATUS_NAMES) else "lost"
        if status == goal.status or goal.status in FINAL_STATUSES:
            return
        goal.status, goal.text = status, event.text
        self._on_goal_change()
        if status in FINAL_STATUSES:
            goal.ended = self.simulated_time
            if self._base is not None:
                self._ended_at[event.identity] = self._base
                self.measure_distances()
        if goal.place is None and status not in FINAL_STATUSES:
            self._unlogged.add(event.identity)  # until the goal comes, on another connection
        else:
            self._log_status(event.identity, goal)

    def _log_status(self, name: str, goal: ProjectGoal) -> None:
        self._unlogged.discard(name)
        detail = f": {goal.text}" if goal.text and goal.status not in ("active", "succeeded") else ""
        number = list(self.goals).index(name) + 1
        self.log(f"goal {number}{at_position(goal.place)} {goal.status}{detail}")

    def _on_marker(self, event: MarkerUpdated) -> None:
        if event.action == DELETE_ALL:
            for marker in list(self._shown):
                self._update_marker(marker, None)
            return
        is_shown = event.action == SHOW and event.is_visible
        self._update_marker((event.name, event.number), event.position[:2] if is_shown else None)

    def _update_marker(self, marker: Tuple[str, int], place: Optional[Tuple[float, float]]) -> None:
        """Update a marker, identified by namespace and id: shown at x, y [m], or hidden (None)."""
        before = self._shown.get(marker)
        if place is None:
            if before is None:
                return
            del self._shown[marker]
            change = "hidden"
        elif before is not None and math.dist(before, place) < SAME_PLACE_DISTANCE:
            return
        else:
            self._shown[marker] = place
            change = f"shown{at_position(place)}"
        x, y = place or before or (0.0, 0.0)
        change_and_cell = (place is None, round(x / SAME_PLACE_DISTANCE), round(y / SAME_PLACE_DISTANCE))
        if change_and_cell not in self._reported_events:
            self._reported_events.add(change_and_cell)
            self.last_event_time = self.simulated_time
            self.markers.append(change)
            self.log(f"marker {change}")

    def _goal(self, name: str) -> ProjectGoal:
        if name not in self.goals:
            self.goals[name] = ProjectGoal(sent=self.simulated_time)
            self._on_goal_change()
        return self.goals[name]

    def _on_goal_change(self) -> None:
        self.last_event_time = self.simulated_time
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
