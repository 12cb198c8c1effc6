"""A command that is run to its end, its time limit, or ours, and leaves no process behind."""

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
# For what has been asked to end, or is just doing so, when its command is over.
ENDING_SECONDS = 5.0


def run_kept(command: Sequence[str], log: Path, limit: float, judge: Callable[[int], Outcome]) -> Outcome:
    """Runs it, with a ROS_HOME of its own beside its log; ``judge`` says what its exit code, and its reports,
    mean. What it leaves running, and not ending, is a failure.

    ``limit``: seconds. Nothing else may run below this process.
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
    """Ends every process below this one, gently at first; returns the names of those that were there."""
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
        return "one that just ended"
