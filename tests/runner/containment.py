"""Run a command until it exits, times out or is interrupted, and end all its child processes."""

import contextlib
import os
import signal
import subprocess
from pathlib import Path
from typing import Callable, List, Sequence

import psutil
from outcome import Outcome, failure

from supervision.processes import adopt_orphans, end_descendants

ROOT = Path(__file__).resolve().parents[2]
GRACE_SECONDS = 15.0
# Time for processes that are ending when their command exits [s].
ENDING_SECONDS = 5.0


def run_contained(
    command: Sequence[str], log: Path, limit: float, judge: Callable[[int], Outcome]
) -> Outcome:
    """Run a command with its own ROS_HOME beside its log. Processes that it leaves behind are a failure.

    This process must have no other children.

    Args:
        command: Command line.
        log: Log file.
        limit: Time limit [s].
        judge: Converts the exit code to an outcome.
    """
    adopt_orphans()
    home = str(log.with_suffix(""))
    environment = {**os.environ, "ROS_HOME": home, "ROS_LOG_DIR": home, "PYTHONUNBUFFERED": "1"}
    try:
        with log.open("w") as output:
            process = subprocess.Popen(
                command,
                cwd=ROOT,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            try:
                outcome = judge(process.wait(limit))
                psutil.wait_procs(psutil.Process().children(recursive=True), timeout=ENDING_SECONDS)
            except subprocess.TimeoutExpired:
                outcome = failure(f"not done after its limit of {limit:.0f} s")
    finally:
        left = sweep()
    if left and not outcome.failed:
        outcome += failure(f"left processes behind: {', '.join(left)}")
    return outcome


def sweep() -> List[str]:
    """End all descendants, with SIGINT first, and return their names."""
    children = psutil.Process().children(recursive=True)
    _, alive = psutil.wait_procs(children, timeout=0.0)
    names = [_name(process) for process in alive]
    for process in alive:
        with contextlib.suppress(psutil.NoSuchProcess):
            process.send_signal(signal.SIGINT)
    psutil.wait_procs(alive, timeout=GRACE_SECONDS)
    end_descendants()
    return names


def _name(process: psutil.Process) -> str:
    try:
        return process.name()
    except psutil.NoSuchProcess:
        return "a process that just ended"
