"""Contracts of the observers of a run.

Both are created before the graph and started once there is a master and the process is a node. They must not
slow the run down. At the end they are asked for their results, even if they were never started because the
graph did not come up.
"""

from typing import Any, Dict, Protocol

from run_report import RunRecord


class Judge(Protocol):
    """Observes ground truth and computes figures."""

    def start(self) -> None:
        """Start to observe."""

    def has_truth(self) -> bool:
        """Whether the true pose of the robot has been received."""

    def status(self) -> str:
        """Return the current state in one line for people."""

    def result_fields(self) -> Dict[str, Any]:
        """Return fields of result.json; none if it was not started."""


class Recorder(Protocol):
    """Records what the report shows."""

    def start(self) -> None:
        """Start to record."""

    def record(self) -> RunRecord:
        """Return everything recorded so far."""
