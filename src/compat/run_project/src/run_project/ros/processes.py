"""Inspection and priority of a project's processes."""

import contextlib
import subprocess
import time
from pathlib import Path
from typing import Collection, Dict, List, NamedTuple, Sequence, Tuple

import psutil

# A process busy-waits if its main thread uses this share of a core for this time [s] and gives it up less
# often than this within a second of it: one that also waits for messages does so more often.
BUSY_CPU_SHARE, BUSY_SECONDS, RESTS_PER_CPU_SECOND = 0.3, 5.0, 5.0
BUSY_NICENESS = 15
# Ages at which a launcher without processes, or a node that is not in the graph, and any other node, whose
# name is not known, no longer count as starting [s].
NODE_SECONDS, PROGRAM_SECONDS = 30.0, 3.0
SHELLS = ("", "bash", "sh", "dash", "zsh")


class ListedProcess(NamedTuple):
    """A process of a run.

    Attributes:
        process: To ask it for more, or to signal it.
        parent: Process that has started it, or has adopted it.
        name: Name of its program, as the kernel shortens it.
        command: Its command line.
        age: Wall time since it was started [s].
    """

    process: psutil.Process
    parent: int
    name: str
    command: List[str]
    age: float


def list_processes(helpers: Sequence["subprocess.Popen[bytes]"]) -> List[ListedProcess]:
    """List all descendants of this process, except some children and what these have started."""
    excluded, listed, now = {helper.pid for helper in helpers}, [], time.time()
    for process in psutil.Process().children(recursive=True):  # parents come before their children
        with contextlib.suppress(psutil.Error), process.oneshot():
            pid, parent = process.pid, process.ppid()
            if parent in excluded or pid in excluded:
                excluded.add(pid)
            elif process.status() != psutil.STATUS_ZOMBIE:
                age = now - process.create_time()
                listed.append(ListedProcess(process, parent, process.name(), process.cmdline(), age))
    return listed


def waits_for_input(process: psutil.Process) -> bool:
    """Whether its main thread is in read(0, ...): system call 0 on x86-64 and 63 on ARM."""
    call = Path(f"/proc/{process.pid}/syscall").read_text().split()
    return call[:2] in (["0", "0x0"], ["63", "0x0"])


class BusyProcesses:
    """Raises the niceness of nodes that never sleep, so that the simulator gets the cores."""

    def __init__(self) -> None:
        self._before: Dict[int, Tuple[float, float, int]] = {}

    def lower_priority(self, processes: List[psutil.Process], now: float) -> None:
        """Look at the processes of a project again, at a wall time [s]; to be called every few seconds."""
        for process in processes:
            with contextlib.suppress(psutil.Error):
                if process.nice() < BUSY_NICENESS and self._is_spinning(process, now):
                    process.nice(BUSY_NICENESS)
                    _lower_session_priority(process)

    def _is_spinning(self, process: psutil.Process, now: float) -> bool:
        """Whether the main thread has used a core since it was last looked at, without giving it up."""
        main = next((thread for thread in process.threads() if thread.id == process.pid), None)
        if main is None:
            return False
        state = (now, main.user_time + main.system_time, process.num_ctx_switches().voluntary)
        before = self._before.setdefault(process.pid, state)
        seconds, used, rests = (new - old for new, old in zip(state, before))
        if seconds < BUSY_SECONDS:
            return False
        self._before[process.pid] = state
        return used > BUSY_CPU_SHARE * seconds and rests < RESTS_PER_CPU_SECOND * used


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


def starting_seconds(
    command: List[str], has_children: bool, is_of_project: bool, nodes: Collection[str]
) -> float:
    """Return the age up to which a process counts as starting [s].

    Args:
        command: Its command line.
        has_children: Whether it has started others.
        is_of_project: Whether its program is one of the project.
        nodes: Names of the nodes in the graph.
    """
    names = [word.partition(":=")[2] for word in command if word.startswith("__name:=")]
    if names:  # of a node that roslaunch has started
        return 0.0 if any(node.rpartition("/")[2] == names[-1] for node in nodes) else NODE_SECONDS
    if any(Path(word).name == "roslaunch" for word in command[:2]):
        return 0.0 if has_children else NODE_SECONDS
    return PROGRAM_SECONDS if is_of_project else 0.0
