"""Whether the threads of a process rest: all wait, none is running or ready to run (proc(5))."""

import os
from pathlib import Path
from typing import Dict

# States of threads that wait, for an event or because they are stopped or have ended.
WAITING_STATES = frozenset(b"SItTXZ")
# Bytes of /proc/PID/task/TID/stat up to the state: two numbers and a name of at most 64 bytes.
STAT_BYTES = 128
PROC = Path("/proc")


class ProcessThreads:
    """Threads of another process on this machine.

    Args:
        pid: Process.
        proc: Folder of the kernel's process information.
    """

    def __init__(self, pid: int, proc: Path = PROC):
        self.pid = pid
        self._folder = proc / str(pid) / "task"
        self._files: Dict[str, int] = {}

    def are_resting(self) -> bool:
        """Return whether all threads wait.

        They are read in both orders: a thread may hand over to one that was read before, and then wait.

        Raises:
            ProcessLookupError: The process has ended.
        """
        try:
            names = os.listdir(self._folder)
        except OSError:
            raise ProcessLookupError(self.pid) from None
        for gone in self._files.keys() - set(names):
            os.close(self._files.pop(gone))
        return all(map(self._is_waiting, (*names, *reversed(names))))

    def close(self) -> None:
        """Close the files of the threads."""
        while self._files:
            os.close(self._files.popitem()[1])

    def _is_waiting(self, name: str) -> bool:
        try:
            if name not in self._files:
                self._files[name] = os.open(self._folder / name / "stat", os.O_RDONLY | os.O_CLOEXEC)
            stat = os.pread(self._files[name], STAT_BYTES, 0)
        except OSError:
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
