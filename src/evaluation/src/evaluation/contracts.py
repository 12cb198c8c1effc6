"""Contracts of the consumers of a run's events.

They are created before the graph and attached once there is a master and the process is a node. They must not
slow the run down. At the end they are asked for their results, even if they were never attached because the
graph did not come up.
"""

from typing import Any, Dict, Protocol

from evaluation.event_stream import EventStream
from run_report import RunRecord


class Consumer(Protocol):
    """Consumes events of a run."""

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""


class Figure(Consumer, Protocol):
    """Computes fields of result.json."""

    def result_fields(self) -> Dict[str, Any]:
        """Return fields of result.json; none if it was not attached."""


class Judge(Figure, Protocol):
    """Observes ground truth and computes figures."""

    def has_truth(self) -> bool:
        """Whether the true pose of the robot has been received."""

    def status(self) -> str:
        """Return the current state in one line for people."""


class Recorder(Consumer, Protocol):
    """Records what the report shows."""

    def record(self) -> RunRecord:
        """Return everything recorded so far."""
