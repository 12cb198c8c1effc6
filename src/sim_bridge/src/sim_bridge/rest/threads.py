"""Whether the threads of a process rest: all wait, none is running or ready to run (proc(5))."""

import os
import time
from pathlib import Path
from typing import Callable, Dict, List, Optional, Tuple

# States of threads that wait, for an event or because they are stopped or have ended.
WAITING_STATES = frozenset(b"SItTXZ")
# Bytes of /proc/PID/task/TID/stat up to the state: two numbers and a name of at most 64 bytes.
STAT_BYTES = 128
PROC = Path("/proc")
# Links of a folder without threads.
FOLDER_LINKS = 2
# Processor time that threads take which only look at the clock: share of the time between two looks at the
# process, and time beyond that [s].
IDLE_SHARE, IDLE_SECONDS = 0.25, 5e-5


class ProcessThreads:
    """Threads of another process on this machine.

    Args:
        pid: Process.
        proc: Folder of the kernel's process information.
        times: Returns wall time and the processor time of the process [s].
    """

    def __init__(
        self, pid: int, proc: Path = PROC, times: Optional[Callable[[], Tuple[float, float]]] = None
    ):
        self.pid = pid
        self._folder = proc / str(pid) / "task"
        self._files: Dict[str, int] = {}
        self._links = -1
        self._times = times or self._measured_times
        self._at_rest: Optional[Tuple[float, float]] = None
        self._is_backward = False

    def are_resting(self) -> bool:
        """Return whether all threads wait, and have hardly run since the last call if they waited then, too.

        Each call reads them in the order opposite to that of the last: a thread may hand over to one that was
        read before, and then wait. Two that hand over to each other again and again may escape both, but not
        that they take time.

        Raises:
            ProcessLookupError: The process has ended.
        """
        self._is_backward = not self._is_backward
        names = self._names()
        if not all(map(self._is_waiting, reversed(names) if self._is_backward else names)):
            self._at_rest = None
            return False
        before, self._at_rest = self._at_rest, self._times()
        if before is None:
            return True
        wall, processor = (now - then for now, then in zip(self._at_rest, before))
        return processor <= IDLE_SHARE * wall + IDLE_SECONDS

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


def _state_in(stat: bytes) -> int:
    """Return the state in a stat file: it follows the name, which ends at the last bracket."""
    return stat[stat.rfind(b")") + 2]


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
