"""Which nodes of a graph have died, and of what, read from what roslaunch and they print."""

import contextlib
import re
import signal
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Collection, Dict, List, Optional

# Of a node without which there is no run, the name stands in the line before.
REQUIRED = re.compile(r"REQUIRED process \[(?P<node>[^\]\[]+?)(-\d+)?\] has died")
EXIT_LINE = re.compile(
    r"(\[(?P<node>[^\]\[]+?)(-\d+)?\] )?process has died \[pid \d+, exit code (?P<code>-?\d+)"
)
ERROR_LINE = re.compile(r"^\[/(?P<node>\S+)\] error: (?P<text>.*)")
BAD_INPUT = 2
# A verdict of the node's own, as of a mission that has failed: no accident.
MISSION_FAILED = 1
MAX_RESTARTS = 3
# Collects what nodes log; nobody needs it to go on, and every roslaunch starts it again.
LOG_COLLECTOR = "rosout"


@dataclass(frozen=True)
class NodeFailure:
    """A node that died with an error: its own words, if it had any, and whether it refused its input."""

    text: str
    is_bad_input: bool


@dataclass(frozen=True)
class Restart:
    """A node that died and was started again."""

    node: str
    reason: str


class NodeExits:
    """Takes down who died. Of the nodes in ``comes_back`` each is started again, a few times, as rosout is.

    ``failure``: the first exit_line for good, None so far. ``restarts``: the others.
    """

    def __init__(self, log_folder: Path, respawned: Collection[str] = ()):
        self.failure: Optional[NodeFailure] = None
        self.restarts: List[Restart] = []
        self._log_folder, self._comes_back = log_folder, {LOG_COLLECTOR, *respawned}
        self._error_lines: Dict[str, str] = {}
        self._required = "a node"
        self._exit_counts: Counter = Counter()

    def read(self, line: str) -> None:
        """A line of roslaunch's output."""
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
    """What an exit code means; a negative one is a signal's number."""
    if code >= 0:
        return f"died with exit code {code}"
    with contextlib.suppress(ValueError):
        return f"was ended by {signal.Signals(-code).name}"
    return f"was ended by signal {-code}"
