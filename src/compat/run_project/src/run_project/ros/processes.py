"""Inspection and priority of a project's processes."""

import contextlib
import time
from pathlib import Path
from typing import List

import psutil

# A process busy-waits if it uses this share of a core for this time [s]; it gets this niceness.
BUSY_CPU_SHARE, BUSY_SECONDS, BUSY_NICENESS = 0.3, 5.0, 15
SHELLS = ("", "bash", "sh", "dash", "zsh")


def waits_for_input(process: psutil.Process) -> bool:
    """Whether its main thread is in read(0, ...): system call 0 on x86-64 and 63 on ARM."""
    call = Path(f"/proc/{process.pid}/syscall").read_text().split()
    return call[:2] in (["0", "0x0"], ["63", "0x0"])


def lower_priority_of_busy_processes(processes: List[psutil.Process]) -> None:
    """Raise the niceness of nodes that never sleep, so that the simulator gets the cores."""
    for process in processes:
        with contextlib.suppress(psutil.Error):
            times, age = process.cpu_times(), time.time() - process.create_time()
            is_busy = age > BUSY_SECONDS and times.user + times.system > BUSY_CPU_SHARE * age
            if is_busy and process.nice() < BUSY_NICENESS:
                process.nice(BUSY_NICENESS)
                _lower_session_priority(process)


def _lower_session_priority(process: psutil.Process) -> None:
    """Autogroup scheduling shares cores between sessions; niceness then counts only within a session."""
    with contextlib.suppress(OSError):
        Path(f"/proc/{process.pid}/autogroup").write_text(f"{BUSY_NICENESS}\n")


def program_of(command: List[str]) -> str:
    """The program file in a command line; empty for a shell."""
    name = Path(command[0]).name if command else ""
    if name in SHELLS:
        return ""
    return command[1] if name.startswith("python") and len(command) > 1 else "".join(command[:1])
