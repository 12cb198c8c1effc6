"""What of a run must be the same when it is repeated: the truth and the decisions, by simulated time."""

import hashlib
from pathlib import Path
from typing import List, NamedTuple, Optional, Sequence, Set, Tuple

from planar import SettingsError, write_atomically

FILE = "trace.txt"
# Nanoseconds before the end from which on messages may still be under way.
UNDER_WAY = 300_000_000


class Entry(NamedTuple):
    """A message: its stamp, ns; the topic; its node; what it says."""

    stamp: int
    topic: str
    node: str
    text: str

    def __str__(self) -> str:
        return f"{self.stamp / 1e9:.9f} {self.topic} {self.node} {self.text}"


class Difference(NamedTuple):
    """Where two runs first differ: entries of the one and of the other, None after the end."""

    here: Optional[str]
    there: Optional[str]


class Trace:
    """Collects entries. It begins with the first goal and ends with the last outcome of what was asked."""

    def __init__(self):
        self._entries: List[Entry] = []
        self._outcomes: Set[Entry] = set()
        self._marks: List[str] = []
        self._start: Optional[int] = None
        self._end: Optional[int] = None

    def note(self, entry: Entry) -> None:
        self._entries.append(entry)

    def mark(self, text: str) -> None:
        """Something without a time: its place among its like is what counts."""
        if self._marks[-1:] != [text]:
            self._marks.append(text)

    def begin(self, stamp: int) -> None:
        """A goal was set; the first one counts."""
        self._start = stamp if self._start is None else min(stamp, self._start)

    def end(self, outcome: Entry) -> None:
        """Something that was asked for has come to this; the last one counts."""
        self._outcomes.add(outcome)
        self._end = outcome.stamp if self._end is None else max(outcome.stamp, self._end)

    def lines(self) -> List[str]:
        """The entries in order."""
        if self._start is None or self._end is None:
            return []
        start, last = self._start, self._end - UNDER_WAY
        seen = {entry for entry in self._entries if start <= entry.stamp <= last}
        outcomes = {entry for entry in self._outcomes if start <= entry.stamp}
        return [*map(str, sorted(seen | outcomes)), *self._marks]

    def content(self) -> bytes:
        """What is written of it; empty if nothing was driven."""
        return "".join(f"{line}\n" for line in self.lines()).encode()


def hash_of(content: bytes) -> str:
    """That of a trace."""
    return hashlib.sha256(content).hexdigest()


def write_trace(folder: Path, content: bytes) -> None:
    """Raises FileWriteError."""
    write_atomically(folder / FILE, content)


def read_trace(folder: Path) -> List[str]:
    """Raises SettingsError if the run has left none."""
    try:
        return (folder / FILE).read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise SettingsError(f"{folder / FILE}: {error.strerror}") from None


def first_difference(here: Sequence[str], there: Sequence[str]) -> Optional[Difference]:
    """The earliest entry that one has and the other has not; None if they are the same."""
    pairs: List[Tuple[Optional[str], Optional[str]]] = list(zip(here, there))
    longer = max(len(here), len(there))
    pairs += [
        (here[i] if i < len(here) else None, there[i] if i < len(there) else None)
        for i in range(len(pairs), longer)
    ]
    return next((Difference(one, other) for one, other in pairs if one != other), None)
