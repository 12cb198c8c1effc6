"""Exits of nodes, parsed from the output of roslaunch and of the nodes."""

import contextlib
import re
import signal
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Collection, Dict, List, Optional

# The name of a required node is in the line before.
REQUIRED = re.compile(r"REQUIRED process \[(?P<node>[^\]\[]+?)(-\d+)?\] has died")
EXIT_LINE = re.compile(
    r"(\[(?P<node>[^\]\[]+?)(-\d+)?\] )?process has died \[pid \d+, exit code (?P<code>-?\d+)"
)
ERROR_LINE = re.compile(r"^\[/(?P<node>\S+)\] error: (?P<text>.*)")
BAD_INPUT = 2
# Exit code of a failed mission, which is no crash.
MISSION_FAILED = 1
MAX_RESTARTS = 3
# Log aggregator; not required by any node, and always restarted by roslaunch.
LOG_COLLECTOR = "rosout"


@dataclass(frozen=True)
class NodeFailure:
    """A node that ended the run.

    Attributes:
        text: Node and reason; the reason is its error line, if it printed one.
        is_bad_input: It rejected its input.
    """

    text: str
    is_bad_input: bool


@dataclass(frozen=True)
class Restart:
    """A node that died and was restarted."""

    node: str
    reason: str


class NodeExits:
    """Parses which nodes have died.

    Args:
        log_folder: Folder of the logs, named in failures without an error line.
        respawned: Nodes that roslaunch restarts, a few times, as it does rosout.

    Attributes:
        failure: First final exit; None so far.
        restarts: Nodes that died and were restarted.
    """

    def __init__(self, log_folder: Path, respawned: Collection[str] = ()):
        self.failure: Optional[NodeFailure] = None
        self.restarts: List[Restart] = []
        self._log_folder, self._comes_back = log_folder, {LOG_COLLECTOR, *respawned}
        self._error_lines: Dict[str, str] = {}
        self._required = "a node"
        self._exit_counts: Counter = Counter()

    def read(self, line: str) -> None:
        """Parse a line of roslaunch's output."""
        error_line, required, exit_line = (
            ERROR_LINE.match(line),
            REQUIRED.search(line),
            EXIT_LINE.search(line),
        )
        if error_line:
            self._error_lines[error_line.group("node")] = error_line.group("text")
        if required:
            self._required = required.group("node")
        if exit_line:
            self._record_exit(exit_line.group("node") or self._required, int(exit_line.group("code")))

    def _record_exit(self, node: str, code: int) -> None:
        reason = self._error_lines.pop(node, None) or describe_exit(code)
        self._exit_counts[node] += 1
        is_crash = code not in (BAD_INPUT, MISSION_FAILED)
        if node in self._comes_back and is_crash and self._exit_counts[node] <= MAX_RESTARTS:
            self.restarts.append(Restart(node, reason))
        elif self.failure is None:
            again = f", after {MAX_RESTARTS} restarts" if self._exit_counts[node] > MAX_RESTARTS else ""
            where = f", see {self._log_folder}" if reason == describe_exit(code) else ""
            self.failure = NodeFailure(f"{node}: {reason}{again}{where}", code == BAD_INPUT)


def describe_exit(code: int) -> str:
    """Describe an exit code in words; a negative one is a signal's number."""
    if code >= 0:
        return f"died with exit code {code}"
    with contextlib.suppress(ValueError):
        return f"was ended by {signal.Signals(-code).name}"
    return f"was ended by signal {-code}"
