"""The log messages of nodes, and a filter for them (rqt_console)."""

from collections import deque
from dataclasses import dataclass
from typing import Deque, List, Tuple

LEVELS = {1: "Debug", 2: "Info", 4: "Warn", 8: "Error", 16: "Fatal"}
MOST_KEPT, MOST_SHOWN = 5000, 200
HEADS = ("Level", "Time", "Node", "Message", "Where")


@dataclass(frozen=True)
class LogEntry:
    """A log message.

    Attributes:
        level: Level as in rosgraph_msgs/Log.
        stamp: ROS time [s].
        node: Name of the node.
        text: The message.
        where: File, line and function.
    """

    level: int
    stamp: float
    node: str
    text: str
    where: str


@dataclass(frozen=True)
class LogFilter:
    """Which log messages are listed.

    Attributes:
        lowest: Lowest level.
        node: Part of the node's name, ignoring case.
        text: Part of the message, ignoring case.
    """

    lowest: int = 1
    node: str = ""
    text: str = ""

    def accepts(self, entry: LogEntry) -> bool:
        return (
            entry.level >= self.lowest
            and self.node.lower() in entry.node.lower()
            and self.text.lower() in entry.text.lower()
        )


class LogBuffer:
    """The last MOST_KEPT log messages."""

    def __init__(self) -> None:
        self._lines: Deque[LogEntry] = deque(maxlen=MOST_KEPT)

    def add(self, entry: LogEntry) -> None:
        self._lines.append(entry)

    def clear(self) -> None:
        self._lines.clear()

    def rows(self, log_filter: LogFilter) -> List[Tuple[str, str, str, str, str]]:
        """Return the accepted messages as table rows, the newest first."""
        rows = []
        for entry in reversed(self._lines):
            if log_filter.accepts(entry):
                level = LEVELS.get(entry.level, str(entry.level))
                rows.append((level, f"{entry.stamp:.3f}", entry.node, entry.text, entry.where))
                if len(rows) == MOST_SHOWN:
                    break
        return rows


def level_named(name: str) -> int:
    return next(level for level, known in LEVELS.items() if known == name)
