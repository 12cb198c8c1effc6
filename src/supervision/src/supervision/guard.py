"""Run a command so that no process is left, even if its parent is killed at any moment.

python3 -m supervision.guard PARENT PATIENCE COMMAND...

Runs the command for the process PARENT until the command ends, SIGTERM is received, or PARENT dies; then
interrupts the command, waits up to PATIENCE seconds, and kills its descendants. The exit code is the
command's. SIGINT is left to the command, which is in the same process group.
"""

import os
import signal
import subprocess
import sys
from threading import Timer
from typing import Any, Callable, List, NoReturn, Optional, Sequence

from supervision.fork_client import exit_like
from supervision.interruption import SIGNALS, on_signals
from supervision.processes import adopt_orphans, end_descendants, end_when_orphaned, ending_with_parent

SIGINT_SECONDS = 2.0


def guarded(command: List[str], patience: float = SIGINT_SECONDS) -> List[str]:
    """Return the command line of a guard of ``command``, to be started by the main thread of this process."""
    return [sys.executable, "-m", "supervision.guard", str(os.getpid()), f"{patience:g}", *command]


def run_guarded(command: List[str], patience: float) -> int:
    """Run a guarded command and wait for its end, so that this process may be killed.

    Termination signals are forwarded to the command.

    Args:
        command: The command.
        patience: Time that the command may take to end [s].

    Returns:
        Exit code; 128 plus the signal's number if a signal ended the command, as in a shell.
    """
    adopt_orphans()
    guard = _start(SIGNALS, subprocess.Popen.terminate, guarded(command, patience), preexec_fn=ignore_ctrl_c)
    code = guard.wait()
    end_descendants(patience)  # in case the guard itself was killed
    return code if code >= 0 else 128 - code


def ignore_ctrl_c() -> None:
    """Ignore SIGINT; for a guard between fork and exec."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def main() -> NoReturn:
    parent, patience, *command = sys.argv[1:]
    adopt_orphans()
    process = _start(
        (signal.SIGTERM,),
        lambda process: _interrupt(process, float(patience)),
        command,
        stdin=subprocess.DEVNULL,
        preexec_fn=ending_with_parent(),
    )
    end_when_orphaned(int(parent), signal.SIGTERM)
    process.wait()
    end_descendants()
    exit_like(process.returncode)


def _start(
    signals: Sequence[signal.Signals],
    ask_to_end: Callable[[subprocess.Popen], None],
    command: List[str],
    **options: Any,
) -> subprocess.Popen:
    """Start a process; a signal to this process asks it to end, even while it is being started."""
    process: Optional[subprocess.Popen] = None
    is_asked = False

    def on_signal(_number: int, _frame: Any) -> None:
        nonlocal is_asked
        is_asked = True
        if process is not None:
            ask_to_end(process)

    on_signals(on_signal, signals)
    process = subprocess.Popen(command, **options)
    if is_asked:
        ask_to_end(process)
    return process


def _interrupt(process: subprocess.Popen, patience: float) -> None:
    """Interrupt a process as Ctrl-C does, and kill it if it takes too long."""
    process.send_signal(signal.SIGINT)
    impatience = Timer(patience, process.kill)
    impatience.daemon = True
    impatience.start()


if __name__ == "__main__":
    main()
