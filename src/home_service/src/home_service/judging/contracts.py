"""What a run asks of those who watch it from outside.

Both are made before there is a graph, and started by the run once there is a master and the process is a
node. Nothing that they do may slow the run down. At the end they are asked for what they saw, also if they
were never started because the graph did not come up.
"""

from typing import Any, Dict, Protocol

from run_report import RunRecord


class Judge(Protocol):
    """Sees what truly happens, and has the figures of it."""

    def start(self) -> None:
        """From now on it watches."""

    def has_truth(self) -> bool:
        """Whether the truth about the robot has been seen."""

    def status(self) -> str:
        """How things stand, in a line for people."""

    def result_fields(self) -> Dict[str, Any]:
        """What belongs into result.json, by its keys; nothing if it was not started."""


class Recorder(Protocol):
    """Keeps what the report shows."""

    def start(self) -> None:
        """From now on it keeps."""

    def record(self) -> RunRecord:
        """All that has been seen so far."""
