"""Goals sent to move_base by hand, and their outcomes."""

from dataclasses import dataclass
from typing import Any, Dict, List, Optional

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
    """Records goals and returns lines for the terminal."""

    def __init__(self):
        self.records: List[GoalRecord] = []
        self._by_id: Dict[str, GoalRecord] = {}
        self._without_id: List[GoalRecord] = []

    def add(self, identity: str, frame: str, pose: Pose2) -> Optional[str]:
        """Add a goal.

        Args:
            identity: Id of the goal; empty if move_base generates it later, as for a click in rviz.
            frame: Frame of the pose.
            pose: Goal pose.

        Returns:
            A line for the terminal; None if the goal is known.
        """
        if identity and identity in self._by_id:
            return None
        record = GoalRecord(len(self.records) + 1, frame, pose)
        self.records.append(record)
        if identity:
            self._by_id[identity] = record
        else:
            self._without_id.append(record)
        return f"{record.name}: on the way"

    def end(self, identity: str, has_reached: bool, text: str, truth: Optional[Pose2]) -> Optional[str]:
        """Record the outcome of a goal.

        Args:
            identity: Id of the goal.
            has_reached: It succeeded.
            text: Status text of move_base.
            truth: True pose of the robot, if known.

        Returns:
            A line for the terminal; None if there is no such goal.
        """
        record = self._by_id.get(identity)
        if record is None and self._without_id:
            record = self._by_id[identity] = self._without_id.pop(
                0
            )  # they end in the order in which they were sent
        if record is None or record.outcome != OPEN:
            return None
        record.outcome = "reached" if has_reached else text or "given up"
        if not has_reached:
            return f"{record.name}: {record.outcome}"
        record.error = None if truth is None else truth.distance_to(record.pose)
        aside = "" if record.error is None else f", truly {record.error:.3f} m from it"
        return f"{record.name}: reached{aside}"

    def result_fields(self) -> Dict[str, Any]:
        """Return fields of result.json; none without goals."""
        return {"goals": [record.as_json() for record in self.records]} if self.records else {}
