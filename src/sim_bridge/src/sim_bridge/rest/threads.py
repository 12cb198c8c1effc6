"""Whether the threads of a process rest: all wait, none is running or ready to run (proc(5))."""

import ctypes
import os
import time
from contextlib import suppress
from pathlib import Path
from typing import Callable, Dict, FrozenSet, List, Optional, Tuple

# States of threads that wait, for an event or because they are stopped or have ended.
WAITING_STATES = frozenset(b"SItTXZ")
# Bytes of /proc/PID/task/TID/stat up to the state: two numbers and a name of at most 64 bytes.
STAT_BYTES = 128
PROC = Path("/proc")
TURNS_LIBRARY = b"libordered_wake"
# Names of the kernel's threads, one for each processor, to which it leaves the network when it is busy.
DELIVERING_THREADS = b"ksoftirqd/"
# Time between two looks at a thread in which one that looks at the clock each millisecond has usually run
# [wall s], and number of such pairs of looks after which a thread is known.
WATCH_SECONDS, WATCHES = 0.0009, 20
# A thread's wait may take so much longer than asked for [ns]: at a barrier short ones follow each other, and
# Linux's default is 50 000.
PR_SET_TIMERSLACK, TIMER_SLACK_NANOSECONDS = 29, 1000
# Numbers of system calls in which a thread sleeps, on x86-64 and ARM.
SLEEP_CALLS = (b"35", b"230", b"101", b"115")
# Links of a folder without threads.
FOLDER_LINKS = 2
# Processor time that threads take which only look at the clock: share of the time between two looks at the
# process, and time beyond that [s]; and the greatest for a process that has rested in between [s].
IDLE_SHARE, IDLE_SECONDS = 0.25, 5e-5
REST_SECONDS = 2e-6


class ProcessThreads:
    """Threads of another process on this machine.

    Args:
        pid: Process.
        proc: Folder of the kernel's process information.
        times: Returns wall time and the processor time of the process [s].

    Attributes:
        take_turns: Whether the preloaded library has the threads run one after another.
        is_native: Whether its program is not Python, whose threads wait for the clock itself.
    """

    def __init__(
        self, pid: int, proc: Path = PROC, times: Optional[Callable[[], Tuple[float, float]]] = None
    ):
        self.pid = pid
        self.take_turns = _has_library(proc / str(pid))
        self._folder = proc / str(pid) / "task"
        self._files: Dict[str, int] = {}
        self._links = -1
        self._times = times or self._measured_times
        self._at_rest: Optional[Tuple[float, float]] = None
        self._is_backward = False
        self.is_native = is_native(pid, proc)
        self._polling = PollingThreads(self._folder) if self.is_native else None

    def may_poll(self) -> bool:
        """Return whether a thread may look at the clock again and again, and learn it at this barrier."""
        with suppress(ProcessLookupError):
            return self._polling is not None and self._polling.may_be_any(self._names())
        return False

    def begin_barrier(self) -> None:
        """Discard the last look: the threads may have run since, for a message or the time."""
        self._at_rest = None
        if self._polling is not None:
            self._polling.stop_watching()

    def are_resting(self) -> bool:
        """Return whether all threads wait, and have not run since the last call if they waited then, too.

        Each call reads them in the order opposite to that of the last: a thread may hand over to one that was
        read before, and then wait. Two that hand over to each other again and again may escape both, but not
        that they take time.

        Raises:
            ProcessLookupError: The process has ended.
        """
        self._is_backward = not self._is_backward
        names = self._names()
        if not all(map(self._is_waiting, reversed(names) if self._is_backward else names)):
            self.begin_barrier()
            return False
        before, self._at_rest = self._at_rest, self._times()
        if self._polling is not None:
            self._polling.watch(self._at_rest[0], names)
        if before is None:
            if self._polling is not None:
                self._polling.mark(names)
            return True
        wall, processor = (now - then for now, then in zip(self._at_rest, before))
        if processor <= REST_SECONDS:
            return True
        is_polling_alone = self._polling is not None and not self._polling.have_others_run()
        return is_polling_alone and processor <= IDLE_SHARE * wall + IDLE_SECONDS

    def have_polled(self) -> bool:
        """Return whether all threads that look at the clock have since the first look at which all waited."""
        return self._polling is None or self._at_rest is not None and self._polling.have_polled()

    def close(self) -> None:
        """Close the files of the threads."""
        while self._files:
            os.close(self._files.popitem()[1])

    def _names(self) -> List[str]:
        """List the threads: again if their number has changed, or if one could not be read.

        The kernel counts a link of the folder for each thread; one that does not is asked at each call.
        """
        try:
            links = self._folder.stat().st_nlink
            if links == self._links and links == len(self._files) + FOLDER_LINKS:
                return list(self._files)
            names = os.listdir(self._folder)
        except OSError:
            raise ProcessLookupError(self.pid) from None
        self._links = links
        for gone in self._files.keys() - set(names):
            os.close(self._files.pop(gone))
        return names

    def _measured_times(self) -> Tuple[float, float]:
        try:
            processor = time.clock_gettime((~self.pid << 3) | 2)  # clock_getcpuclockid(3)
        except OSError:
            processor = 0.0  # it has ended
        return time.monotonic(), processor

    def _is_waiting(self, name: str) -> bool:
        try:
            if name not in self._files:
                self._files[name] = os.open(f"{self._folder}/{name}/stat", os.O_RDONLY | os.O_CLOEXEC)
            stat = os.pread(self._files[name], STAT_BYTES, 0)
        except OSError:
            self._links = -1
            return True  # the thread has ended
        return _state_in(stat) in WAITING_STATES


class KernelThreads:
    """The kernel's threads that deliver messages on a busy machine, which may take milliseconds.

    While such a thread is ready to run, what processes send each other waits for it. Not visible in
    containers.

    Args:
        proc: Folder of the kernel's process information.
    """

    def __init__(self, proc: Path = PROC):
        self._files: List[int] = []
        for folder in proc.glob("[0-9]*"):
            with suppress(OSError):
                if (folder / "comm").read_bytes().startswith(DELIVERING_THREADS):
                    self._files.append(os.open(folder / "stat", os.O_RDONLY | os.O_CLOEXEC))

    def are_resting(self) -> bool:
        """Return whether none is running or ready to run."""
        return all(_state_in(os.pread(file, STAT_BYTES, 0)) in WAITING_STATES for file in self._files)


class PollingThreads:
    """Learns which threads of a process of roscpp look at the clock each millisecond, as its timers do.

    Args:
        folder: Folder of the kernel's information on the threads.
    """

    def __init__(self, folder: Path):
        self._folder = folder
        self._counts: Dict[str, Tuple[int, int]] = {}
        self._seen: Optional[Dict[str, bytes]] = None
        self._since = 0.0
        self._others: Dict[str, bytes] = {}
        self._marks: Dict[str, bytes] = {}
        self._sleeping: FrozenSet[str] = frozenset()

    def may_be_any(self, names: List[str]) -> bool:
        """Return whether a thread sleeps, looks at the clock, or is unknown; begin to watch the unknown.

        Args:
            names: Numbers of the threads.
        """
        for gone in self._counts.keys() - names:
            del self._counts[gone]
        self._seen, self._since = {}, 0.0
        self._sleeping = frozenset(n for n in names if self._read(n, "syscall").split()[0] in SLEEP_CALLS)
        return any(map(self._may_poll, names))

    def watch(self, wall: float, names: List[str]) -> None:
        """Note whether threads have run since the last look; at a look at which all of them rest.

        Args:
            wall: Wall time [s].
            names: Numbers of the threads.
        """
        if not self._others:
            self._others = {name: self._runs(name) for name in names if not self._may_poll(name)}
        if self._seen is None or wall - self._since < WATCH_SECONDS:
            return
        unknown = [name for name in names if self._counts.get(name, (0, 0))[0] < WATCHES]
        now = {name: self._runs(name) for name in unknown}
        for name in now.keys() & self._seen.keys():
            watches, runs = self._counts.get(name, (0, 0))
            self._counts[name] = (watches + 1, runs + (now[name] != self._seen[name]))
        self._seen, self._since = now or None, wall

    def mark(self, names: List[str]) -> None:
        """Note how often the threads have run that may look at the clock."""
        self._marks = {name: self._runs(name) for name in names if self._may_poll(name)}

    def have_polled(self) -> bool:
        """Return whether all of these have run since they were marked."""
        return all(self._runs(name) != runs for name, runs in self._marks.items())

    def have_others_run(self) -> bool:
        """Return whether threads that do not look at the clock have run since the last call or first look."""
        now = {name: self._runs(name) for name in self._others}
        before, self._others = self._others, now
        return now != before

    def stop_watching(self) -> None:
        """Discard the last look."""
        self._seen, self._others = None, {}

    def _may_poll(self, name: str) -> bool:
        """Whether a thread looks at the clock, as one that sleeps does until it wakes up, or is unknown."""
        watches, runs = self._counts.get(name, (0, 0))
        return name in self._sleeping or watches < WATCHES or 2 * runs >= WATCHES

    def _runs(self, name: str) -> bytes:
        """How often a thread has run."""
        return self._read(name, "schedstat").split()[-1]

    def _read(self, name: str, file: str) -> bytes:
        try:
            number = os.open(f"{self._folder}/{name}/{file}", os.O_RDONLY | os.O_CLOEXEC)
        except OSError:
            return b"0"  # it has ended
        try:
            return os.read(number, STAT_BYTES) or b"0"
        except OSError:
            return b"0"
        finally:
            os.close(number)


def _state_in(stat: bytes) -> int:
    """Return the state in a stat file: it follows the name, which ends at the last bracket."""
    return stat[stat.rfind(b")") + 2]


def _has_library(folder: Path) -> bool:
    try:
        return TURNS_LIBRARY in (folder / "environ").read_bytes()
    except OSError:
        return False


def wake_promptly() -> None:
    """Have the waits of the calling thread end on time."""
    ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, TIMER_SLACK_NANOSECONDS, 0, 0, 0)


def has_ended(pid: int, proc: Path = PROC) -> bool:
    """Return whether a process has ended, also if its parent has not noticed yet.

    Args:
        pid: Process.
        proc: Folder of the kernel's process information.
    """
    try:
        stat = (proc / str(pid) / "stat").read_bytes()
    except OSError:
        return True
    return _state_in(stat) in b"ZX"


def is_native(pid: int, proc: Path = PROC) -> bool:
    """Return whether a process runs a program that is not Python, such as a node of roscpp.

    Args:
        pid: Process.
        proc: Folder of the kernel's process information.
    """
    try:
        return "python" not in Path(os.readlink(proc / str(pid) / "exe")).name
    except OSError:
        return False
