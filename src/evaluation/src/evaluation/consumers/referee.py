"""The referee observes a run from outside the robot and judges it."""

import time
from typing import Any, Callable, Dict, List, Mapping, Optional, Set, Tuple

from evaluation.consumers.figures import FIGURES
from evaluation.consumers.goal_log import GoalLog
from evaluation.consumers.log_printer import LogPrinter
from evaluation.consumers.mission_monitor import MissionMonitor
from evaluation.consumers.motion_monitor import MotionMonitor
from evaluation.contracts import Consumer, Figure
from evaluation.event_stream import EventStream
from evaluation.events import StateUpdated
from evaluation.verdict import FINAL_STATES, MissionRecord, Verdict, collision, judge
from planar import Pose2
from planar.maps.places import NamedPlace


class Referee:
    """Judges a run by its events, and computes its figures.

    Args:
        places: Places by name; places of a mission that is sent to the robot are added.
        log: Called with each line for people.
        logs_goals: Log goals of move_base and their outcomes, too.
        idle_text: State in words while no mission is under way; empty: the last state.
        clock: Returns the wall-clock time [s].

    Attributes:
        state: Current state of the mission.
    """

    def __init__(
        self,
        places: Mapping[str, NamedPlace],
        log: Callable[[str], None],
        logs_goals: bool = False,
        idle_text: str = "",
        clock: Callable[[], float] = time.monotonic,
    ):
        self.state = ""
        self._idle_text = idle_text
        self._motion = MotionMonitor(clock)
        self._mission = MissionMonitor(places, log, clock)
        self._log_printer = LogPrinter(log)
        self._figures: List[Figure] = [*(figure() for figure in FIGURES), self._motion]
        if logs_goals:
            self._figures.append(GoalLog(log))
        self._is_attached = False

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        self._is_attached = True
        events.subscribe(StateUpdated, self._on_state)
        consumers: Tuple[Consumer, ...] = (*self._figures, self._mission, self._log_printer)
        for consumer in consumers:
            consumer.attach(events)

    @property
    def mission_record(self) -> MissionRecord:
        """Observations of the run."""
        return self._mission.record

    @property
    def truth(self) -> Optional[Pose2]:
        """Latest true pose."""
        return self._motion.truth

    @property
    def simulated_time(self) -> float:
        """Its stamp [s]."""
        return self._motion.simulated_time

    @property
    def simulated_seconds(self) -> float:
        """Simulated time since the first ground truth [s]."""
        return self._motion.simulated_seconds

    @property
    def collision(self) -> Optional[str]:
        """What the robot has collided with, in words; None if nothing."""
        return collision(self.mission_record.collisions)

    def has_truth(self) -> bool:
        """Whether the true pose of the robot has been received."""
        return self.truth is not None

    def has_seen(self, expected: Set[str]) -> bool:
        """Whether everything expected has been observed, or can no longer occur."""
        return self.mission_record.is_complete(expected) or self._mission.is_past_grace_period

    def verdict(self, expected: Set[str], failure: Optional[str] = None) -> Verdict:
        """Return the verdict; ``failure``: why the run was cut short, if so."""
        self.mission_record.failure = failure or self.mission_record.failure
        return judge(self.mission_record, expected)

    def distance_from(self, pose: Pose2) -> float:
        """Return the true distance of the robot from a pose in the world [m]; requires ground truth."""
        assert self.truth is not None
        return self.truth.distance_to(pose)

    def status(self) -> str:
        """Return the current state in one line."""
        is_idle = self.state in ("", *FINAL_STATES)
        activity = (is_idle and self._idle_text) or self.state or "running"
        return f"{activity}: {self._motion.status}"

    def result_fields(self) -> Dict[str, Any]:
        """Return fields of result.json; none if it was not attached."""
        if not self._is_attached:
            return {}
        fields: Dict[str, Any] = {}
        for figure in self._figures:
            fields.update(figure.result_fields())
        return {**fields, **self.mission_record.result_fields()}

    def _on_state(self, event: StateUpdated) -> None:
        self.state = event.text
