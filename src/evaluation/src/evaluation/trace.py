"""Trace of a run: ground truth and decisions by simulated time, which must be equal in a repeated run."""

import hashlib
import math
import os
import tempfile
import threading
from pathlib import Path
from typing import IO, Iterator, List, NamedTuple, Optional, Sequence, Set, Tuple

from planar import FileWriteError, SettingsError, write_atomically

FILE = "trace.txt"
# Time before the end in which messages may still be in flight [ns].
IN_FLIGHT = 300_000_000
# Time after which no more entries arrive [ns], and number of entries of a run of some minutes.
LATE, MAX_IN_MEMORY = 10_000_000_000, 10_000


class TraceEntry(NamedTuple):
    """A message.

    Attributes:
        stamp: Stamp [ns].
        topic: Resolved topic.
        node: Publishing node.
        text: Content.
    """

    stamp: int
    topic: str
    node: str
    text: str

    def __str__(self) -> str:
        return f"{self.stamp / 1e9:.9f} {self.topic} {self.node} {_on_one_line(self.text)}"


class TraceDifference(NamedTuple):
    """First difference of two traces: the entry of each, None after its end."""

    here: Optional[str]
    there: Optional[str]


class Trace:
    """Messages of a run from the first goal to the last outcome, in the order of their stamps.

    The latest ``max_in_memory`` entries are kept in memory, older ones in a temporary file.
    """

    def __init__(self, max_in_memory: int = MAX_IN_MEMORY):
        self._max_in_memory = max_in_memory
        self._entries: List[TraceEntry] = []
        self._outcomes: Set[TraceEntry] = set()
        self._unstamped: List[str] = []
        self._start: Optional[int] = None
        self._end: Optional[int] = None
        self._spill_file: Optional[IO[str]] = None
        self._write_error: Optional[str] = None
        self._lock = threading.Lock()

    def add(self, entry: TraceEntry) -> None:
        """Add an entry."""
        with self._lock:
            if self._write_error is None:
                self._entries.append(entry)
            if len(self._entries) > self._max_in_memory:
                self._spill(max(each.stamp for each in self._entries) - LATE)

    def add_unstamped(self, text: str) -> None:
        """Add text without a stamp; only the order of such texts is compared."""
        line = _on_one_line(text)
        if self._unstamped[-1:] != [line]:
            self._unstamped.append(line)

    def start(self, stamp: int) -> None:
        """Start the trace at a goal; the first one counts."""
        self._start = stamp if self._start is None else min(stamp, self._start)

    def end(self, outcome: TraceEntry) -> None:
        """End the trace with the outcome of a request; the last one counts."""
        self._outcomes.add(outcome)
        self._end = outcome.stamp if self._end is None else max(outcome.stamp, self._end)

    def is_settled(self, now: int) -> bool:
        """Whether messages sent before the last outcome are no longer in flight at this time [ns]."""
        return self._end is None or now > self._end + IN_FLIGHT

    def lines(self) -> List[str]:
        """Return the entries in order.

        Raises:
            FileWriteError: If entries were lost because the temporary file could not be written.
        """
        with self._lock:
            if self._write_error is not None:
                raise FileWriteError(f"{FILE}: cannot be written ({self._write_error})")
            if self._start is None or self._end is None:
                return []
            last = self._end - IN_FLIGHT
            return [*self._spilled_lines(last), *map(str, self._entries_until(last)), *self._unstamped]

    def content(self) -> bytes:
        """Return the content of trace.txt, empty if nothing was driven; raises as ``lines``."""
        return "".join(f"{line}\n" for line in self.lines()).encode()

    def _entries_until(self, last: int, last_outcome: float = math.inf) -> List[TraceEntry]:
        """Return the relevant entries in memory, in order."""
        if self._start is None:
            return []
        seen = {entry for entry in self._entries if self._start <= entry.stamp <= last}
        return sorted(seen | {one for one in self._outcomes if self._start <= one.stamp <= last_outcome})

    def _spill(self, last: int) -> None:
        """Move entries up to a stamp to the temporary file."""
        try:
            if self._spill_file is None:
                self._spill_file = tempfile.TemporaryFile("w+", encoding="utf-8")  # noqa: SIM115
            self._spill_file.seek(0, os.SEEK_END)
            for entry in self._entries_until(last, last):
                self._spill_file.write(f"{entry.stamp} {int(entry in self._outcomes)} {entry}\n")
            self._spill_file.flush()
        except OSError as error:
            self._write_error, self._entries = error.strerror, []
        self._entries = [entry for entry in self._entries if entry.stamp > last]
        self._outcomes -= {one for one in self._outcomes if one.stamp <= last}

    def _spilled_lines(self, last: int) -> Iterator[str]:
        """Yield the relevant lines of the temporary file, which may go beyond ``last``."""
        if self._spill_file is not None:
            self._spill_file.seek(0)
            for line in self._spill_file:
                stamp, is_outcome, text = line.rstrip("\n").split(" ", 2)
                if int(stamp) <= last or is_outcome == "1":
                    yield text


def _on_one_line(text: str) -> str:
    """Return text with line breaks and other unprintable characters escaped: names may contain them."""
    if text.isprintable():
        return text
    return "".join(each if each.isprintable() else each.encode("unicode_escape").decode() for each in text)


def hash_of(content: bytes) -> str:
    """Return the hash of a trace's content."""
    return hashlib.sha256(content).hexdigest()


def write_trace(folder: Path, content: bytes) -> None:
    """Write trace.txt to a run folder."""
    write_atomically(folder / FILE, content)


def read_trace(folder: Path) -> List[str]:
    """Read trace.txt of a run folder.

    Raises:
        SettingsError: If there is none.
    """
    try:
        return (folder / FILE).read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise SettingsError(f"{folder / FILE}: {error.strerror}") from None


def first_difference(here: Sequence[str], there: Sequence[str]) -> Optional[TraceDifference]:
    """Return the first difference of two traces; None if they are equal."""
    pairs: List[Tuple[Optional[str], Optional[str]]] = list(zip(here, there))
    longer = max(len(here), len(there))
    pairs += [
        (here[i] if i < len(here) else None, there[i] if i < len(there) else None)
        for i in range(len(pairs), longer)
    ]
    return next((TraceDifference(one, other) for one, other in pairs if one != other), None)
