"""What nodes have said, and of that what a person wants to read (rqt_console)."""

from collections import deque
from dataclasses import dataclass
from typing import Deque, List, Tuple

LEVELS = {1: "Debug", 2: "Info", 4: "Warn", 8: "Error", 16: "Fatal"}
MOST_KEPT, MOST_SHOWN = 5000, 200
HEADS = ("Level", "Time", "Node", "Message", "Where")


@dataclass(frozen=True)
class Said:
    """A line of a log; ``stamp``: seconds of ROS time; ``where``: in its source."""

    level: int
    stamp: float
    node: str
    text: str
    where: str


@dataclass(frozen=True)
class Wanted:
    """``lowest``: level; ``node``, ``text``: parts of names and messages, in whatever case."""

    lowest: int = 1
    node: str = ""
    text: str = ""

    def takes(self, said: Said) -> bool:
        return (
            said.level >= self.lowest
            and self.node.lower() in said.node.lower()
            and self.text.lower() in said.text.lower()
        )


class Log:
    """The last MOST_KEPT lines."""

    def __init__(self) -> None:
        self._lines: Deque[Said] = deque(maxlen=MOST_KEPT)

    def add(self, said: Said) -> None:
        self._lines.append(said)

    def clear(self) -> None:
        self._lines.clear()

    def rows(self, wanted: Wanted) -> List[Tuple[str, str, str, str, str]]:
        """The newest that are wanted, the newest first."""
        rows = []
        for said in reversed(self._lines):
            if wanted.takes(said):
                level = LEVELS.get(said.level, str(said.level))
                rows.append((level, f"{said.stamp:.3f}", said.node, said.text, said.where))
                if len(rows) == MOST_SHOWN:
                    break
        return rows


def level_named(name: str) -> int:
    return next(level for level, known in LEVELS.items() if known == name)
