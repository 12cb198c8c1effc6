"""Inspection and priority of a project's processes."""

import contextlib
import subprocess
import time
from pathlib import Path
from typing import AbstractSet, Dict, Iterable, List, NamedTuple, Sequence, Set, Tuple

import psutil

from run_project.stand_ins import STAND_INS
from sim_bridge.rest.threads import SLEEP_CALLS

# A process busy-waits if its main thread uses this share of a core for this time [s] and gives it up less
# often than this within a second of it: one that also waits for messages does so more often.
BUSY_CPU_SHARE, BUSY_SECONDS, RESTS_PER_CPU_SECOND = 0.3, 5.0, 5.0
BUSY_NICENESS = 15
# Ages at which a launcher without processes, or a node that it has started, and any other program that is not
# in the graph, such as a shell that reads set-up files, no longer count as starting [s].
NODE_SECONDS, PROGRAM_SECONDS = 30.0, 3.0
# Programs with the simulation's clock.
SIMULATORS = frozenset(("gazebo", "gzserver", "debug"))
# A program that only shows what others publish.
OBSERVER = "rviz"
SHELLS = ("", "bash", "sh", "dash", "zsh")
# A wait of one thread from which on it counts as long [s]: those of roscpp and rospy last half a second.
LONG_SLEEP_SECONDS = 1.0
# Age up to which a program begins [s].
BEGIN_SECONDS = 3.0
# Numbers of system calls on x86-64 and ARM: waits for files; waits for other threads.
SELECTS, FUTEXES = (b"23", b"270", b"72"), (b"202", b"98")


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


def is_time_due(commands: Iterable[List[str]], awaited: str, present: AbstractSet[str]) -> bool:
    """Whether a simulator runs, and all nodes are in the graph that its time waits for.

    Args:
        commands: Command lines of the processes.
        awaited: Names of the nodes, separated by spaces.
        present: Names of the nodes in the graph, without namespace.
    """
    is_running = any(not SIMULATORS.isdisjoint(Path(word).name for word in each[:2]) for each in commands)
    return is_running and present >= {name.rpartition("/")[2] for name in awaited.split()}


def starting_seconds(each: ListedProcess, has_children: bool, is_node: bool) -> float:
    """Return the age up to which a process counts as starting [s].

    Args:
        each: The process.
        has_children: Whether it has started others.
        is_node: Whether it is a node of the graph.
    """
    if has_children or is_node:
        return 0.0
    names = [Path(word).name for word in each.command[:2]]
    if OBSERVER in names:
        return 0.0
    is_launched = any(word.startswith("__name:=") for word in each.command)
    if is_launched or "roslaunch" in names:
        return NODE_SECONDS
    is_sleeping = program_of(each.command) == str(STAND_INS / "bin" / "sleep")
    return 0.0 if is_sleeping else PROGRAM_SECONDS


class WallSleeps:
    """Finds processes with a thread that sleeps for long by wall time: what they do next may still come."""

    def __init__(self, proc: Path = Path("/proc")):
        self._proc = proc
        self._resting: Dict[Tuple[int, str], Tuple[bytes, float]] = {}

    def are_any(self, processes: Sequence[psutil.Process], now: float) -> bool:
        """Return whether a thread has been in one sleep for long, at a wall time [s]; call it repeatedly."""
        present = {
            (process.pid, thread.name): thread
            for process in processes
            for thread in self._proc.glob(f"{process.pid}/task/*")
        }
        before, self._resting = self._resting, {}
        for key, thread in present.items():
            with contextlib.suppress(OSError):  # it has ended
                state = _timed_wait(thread)
                if state:
                    known = before.get(key)
                    self._resting[key] = known if known and known[0] == state else (state, now)
        return any(now - since > LONG_SLEEP_SECONDS for _, since in self._resting.values())


class FirstSleeps:
    """Finds programs that sleep by wall time as they begin, as until their first subscriber has come.

    Those in Python are left out: the main thread of a rospy node sleeps by wall time all the while.
    """

    def __init__(self, proc: Path = Path("/proc")):
        self._proc = proc
        self._asleep: Set[Tuple[int, bytes]] = set()

    def are_any(self, listed: Sequence[ListedProcess]) -> bool:
        """Return whether a main thread is in the same sleep as at the last look.

        A sleep of roscpp in simulated time consists of many short ones.
        """
        before, self._asleep = self._asleep, set()
        for each in listed:
            is_python = Path(each.command[0]).name.startswith("python") if each.command else True
            if each.age < BEGIN_SECONDS and not is_python:
                with contextlib.suppress(OSError):  # it has ended
                    state = _timed_wait(self._proc / f"{each.process.pid}/task/{each.process.pid}")
                    if state.partition(b" ")[0] in SLEEP_CALLS:
                        self._asleep.add((each.process.pid, state))
        return not before.isdisjoint(self._asleep)


def _timed_wait(thread: Path) -> bytes:
    """What identifies the sleep of a thread, or its wait with a limit for another; empty if it is in none."""
    try:
        text = (thread / "syscall").read_bytes()
    except PermissionError:
        return b"unknown"
    number, *arguments = text.split()
    if number in SELECTS:
        is_timed = int(arguments[0], 16) == 0  # of no file: a sleep
    else:
        is_timed = number in SLEEP_CALLS or (number in FUTEXES and int(arguments[3], 16) != 0)
    lines = (thread / "status").read_bytes().splitlines()
    return text + next(line for line in lines if line.startswith(b"voluntary")) if is_timed else b""
