"""A program started from the page."""

import os
import signal
import subprocess
from typing import List, Sequence

from supervision.guard import guarded

END_SECONDS = 5.0


class ChildProgram:
    """A child process that receives SIGINT when it is ended or when this process exits.

    Args:
        command: Program and arguments.
    """

    def __init__(self, command: Sequence[str]):
        self._process = subprocess.Popen(
            guarded(list(command), END_SECONDS),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )

    @property
    def is_running(self) -> bool:
        return self._process.poll() is None

    def complaints(self) -> List[str]:
        """Return the last line of its error output if it failed."""
        if self.is_running or self._process.returncode in (0, -signal.SIGINT):
            return []
        assert self._process.stderr is not None
        lines = self._process.stderr.read().decode(errors="replace").split("\n")
        return [line.strip()[:200] for line in lines if line.strip()][-1:]

    def end(self) -> None:
        if self.is_running:
            self._process.terminate()
            try:
                self._process.wait(2.0 * END_SECONDS)
            except subprocess.TimeoutExpired:
                os.killpg(self._process.pid, signal.SIGKILL)
                self._process.wait()
