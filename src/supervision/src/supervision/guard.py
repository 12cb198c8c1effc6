"""A command that leaves no process behind, also if whoever has started it is killed at any moment.

python3 -m supervision.guard PARENT PATIENCE COMMAND...

Started by the process PARENT, it runs the command until that ends, or this is sent SIGTERM, or PARENT is no
more; upon which the command is ended as by Ctrl-C, within PATIENCE seconds, and then whatever it has started.
The exit code is the command's. SIGINT is for the command alone, which is in the same process group.
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
    """The command line of a guard of ``command``, for a child of this process, started by its main thread."""
    return [sys.executable, "-m", "supervision.guard", str(os.getpid()), f"{patience:g}", *command]


def run_guarded(command: List[str], patience: float) -> int:
    """Runs a command that takes ``patience`` seconds to end when it is asked to; returns its exit code.

    One that a signal has ended has 128 and the signal's number, as in a shell.

    This process only waits, so that it may be killed: see above. What asks it to end is for the command.
    """
    adopt_orphans()
    guard = _start(SIGNALS, subprocess.Popen.terminate, guarded(command, patience), preexec_fn=ignore_ctrl_c)
    code = guard.wait()
    end_descendants(patience)  # of a guard that was killed itself
    return code if code >= 0 else 128 - code


def ignore_ctrl_c() -> None:
    """For a guard between fork and exec."""
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
    """A process that is asked to end when this one is sent one of the signals, from the first moment on."""
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
    """As Ctrl-C does; kills it if it takes too long over that."""
    process.send_signal(signal.SIGINT)
    impatience = Timer(patience, process.kill)
    impatience.daemon = True
    impatience.start()


if __name__ == "__main__":
    main()
