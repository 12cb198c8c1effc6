"""Goals sent to move_base by hand, and their outcomes."""

from dataclasses import dataclass
from typing import Any, Callable, Dict, List, Optional

from evaluation.event_stream import EventStream
from evaluation.events import SUCCEEDED, GoalEnded, GoalRequested, TruthUpdated
from planar import Pose2

OPEN = "open"


@dataclass
class GoalRecord:
    """A goal and its outcome.

    Attributes:
        number: Number of the goal, from 1.
        frame: Frame of the pose.
        pose: Goal pose.
        outcome: "reached", why it was not, or "open".
        error: True distance from the goal on arrival [m].
    """

    number: int
    frame: str
    pose: Pose2
    outcome: str = OPEN
    error: Optional[float] = None

    @property
    def name(self) -> str:
        pose = self.pose
        return f"goal {self.number} ({pose.x:.2f}, {pose.y:.2f}, {pose.yaw:.2f})"

    def as_json(self) -> Dict[str, Any]:
        """Return the record as written to result.json."""
        pose = [round(value, 3) for value in (self.pose.x, self.pose.y, self.pose.yaw)]
        record: Dict[str, Any] = {"goal": pose, "frame": self.frame, "outcome": self.outcome}
        return record if self.error is None else {**record, "error": round(self.error, 3)}


class GoalLog:
    """Records goals that are sent by hand, and prints them.

    Args:
        log: Called with each line for people.
    """

    def __init__(self, log: Callable[[str], None]):
        self.records: List[GoalRecord] = []
        self._log = log
        self._by_id: Dict[str, GoalRecord] = {}
        self._without_id: List[GoalRecord] = []
        self._truth: Optional[Pose2] = None

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(TruthUpdated, self._on_truth)
        events.subscribe(GoalRequested, self._on_request)
        events.subscribe(GoalEnded, self._on_end)

    def result_fields(self) -> Dict[str, Any]:
        """Return fields of result.json; none without goals."""
        return {"goals": [record.as_json() for record in self.records]} if self.records else {}

    def _on_truth(self, event: TruthUpdated) -> None:
        self._truth = event.pose

    def _on_request(self, event: GoalRequested) -> None:
        if event.identity and event.identity in self._by_id:
            return
        record = GoalRecord(len(self.records) + 1, event.frame, event.pose)
        self.records.append(record)
        if event.identity:
            self._by_id[event.identity] = record
        else:
            self._without_id.append(record)
        self._log(f"{record.name}: on the way")

    def _on_end(self, event: GoalEnded) -> None:
        record = self._by_id.get(event.identity)
        if record is None and self._without_id:
            # They end in the order in which they were sent.
            record = self._by_id[event.identity] = self._without_id.pop(0)
        if record is None or record.outcome != OPEN:
            return
        if event.status != SUCCEEDED:
            record.outcome = event.text or "given up"
            self._log(f"{record.name}: {record.outcome}")
            return
        record.outcome = "reached"
        record.error = None if self._truth is None else self._truth.distance_to(record.pose)
        aside = "" if record.error is None else f", truly {record.error:.3f} m from it"
        self._log(f"{record.name}: reached{aside}")
