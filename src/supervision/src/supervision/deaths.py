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
DIED = re.compile(r"(\[(?P<node>[^\]\[]+?)(-\d+)?\] )?process has died \[pid \d+, exit code (?P<code>-?\d+)")
COMPLAINT = re.compile(r"^\[/(?P<node>\S+)\] error: (?P<text>.*)")
BAD_INPUT = 2
# A verdict of the node's own, as of a mission that has failed: no accident.
VERDICT = 1
MOST_RESTARTS = 3
# Collects what nodes log; nobody needs it to go on, and every roslaunch starts it again.
COLLECTOR = "rosout"


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


class Deaths:
    """Takes down who died. Of the nodes in ``comes_back`` each is started again, a few times, as rosout is.

    ``failure``: the first death for good, None so far. ``restarts``: the others.
    """

    def __init__(self, log_folder: Path, comes_back: Collection[str] = ()):
        self.failure: Optional[NodeFailure] = None
        self.restarts: List[Restart] = []
        self._log_folder, self._comes_back = log_folder, {COLLECTOR, *comes_back}
        self._complaints: Dict[str, str] = {}
        self._required = "a node"
        self._deaths: Counter = Counter()

    def read(self, line: str) -> None:
        """A line of roslaunch's output."""
        complaint, required, death = COMPLAINT.match(line), REQUIRED.search(line), DIED.search(line)
        if complaint:
            self._complaints[complaint.group("node")] = complaint.group("text")
        if required:
            self._required = required.group("node")
        if death:
            self._note(death.group("node") or self._required, int(death.group("code")))

    def _note(self, node: str, code: int) -> None:
        reason = self._complaints.pop(node, None) or end_in_words(code)
        self._deaths[node] += 1
        is_accident = code not in (BAD_INPUT, VERDICT)
        if node in self._comes_back and is_accident and self._deaths[node] <= MOST_RESTARTS:
            self.restarts.append(Restart(node, reason))
        elif self.failure is None:
            again = f", after {MOST_RESTARTS} restarts" if self._deaths[node] > MOST_RESTARTS else ""
            where = f", see {self._log_folder}" if reason == end_in_words(code) else ""
            self.failure = NodeFailure(f"{node}: {reason}{again}{where}", code == BAD_INPUT)


def end_in_words(code: int) -> str:
    """What an exit code means; a negative one is a signal's number."""
    if code >= 0:
        return f"died with exit code {code}"
    with contextlib.suppress(ValueError):
        return f"was ended by {signal.Signals(-code).name}"
    return f"was ended by signal {-code}"
