"""The cockpit as a child process of a run."""

import contextlib
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import List, Mapping, Optional, Sequence

from cockpit.errors import CockpitError, PortError
from supervision.processes import ending_with_parent

# Default address of the page.
FREE_PORT = "127.0.0.1:0"
URL, ERROR = "cockpit: http", "error: "
START_SECONDS, CLOSE_SECONDS, POLL_SECONDS = 120.0, 2.0, 0.02


class CockpitProcess:
    """Starts the cockpit for the graph of ``ROS_MASTER_URI``, whose master may start later.

    Args:
        where: [ADDRESS:]PORT of the page.
        log: Log file.
        environment: Environment variables; None to inherit them.
        tool: Name of a tool that is opened first.
        prefix: Words in front of the command, such as those of a sandbox.

    Raises:
        PortError: If the page cannot be served at ``where``.
        CockpitError: If the process does not start.
    """

    def __init__(
        self,
        where: str,
        log: Path,
        environment: Optional[Mapping[str, str]] = None,
        tool: Optional[str] = None,
        prefix: Sequence[str] = (),
    ):
        self._lines: List[str] = []
        self._log = log
        opened = [] if tool is None else ["--tool", tool]
        self._process = subprocess.Popen(
            [*prefix, sys.executable, "-m", "cockpit.ros.node", "--web-port", where, *opened],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            env=None if environment is None else dict(environment),
            start_new_session=True,
            preexec_fn=ending_with_parent(signal.SIGTERM),
        )
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()
        self.url = self._wait_for_url()

    def close(self) -> None:
        """End the process; open pages show that the connection is lost."""
        self._process.send_signal(signal.SIGTERM)
        try:
            self._process.wait(CLOSE_SECONDS)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _wait_for_url(self) -> str:
        deadline = time.monotonic() + START_SECONDS
        while time.monotonic() < deadline:
            has_ended = not self._reading.is_alive()
            for line in list(self._lines):
                if line.startswith(URL):
                    return line.partition(": ")[2].strip()
                if line.startswith(ERROR):
                    raise PortError(line.partition(": ")[2].strip())
            if has_ended:
                break
            time.sleep(POLL_SECONDS)
        self.close()
        raise CockpitError(f"the cockpit did not start, see {self._log}")

    def _read(self) -> None:
        """Read the output even if the log cannot be written: a full pipe would block the process."""
        with contextlib.ExitStack() as stack:
            log = None
            with contextlib.suppress(OSError):
                log = stack.enter_context(self._log.open("w", encoding="utf-8", buffering=1))
            for line in self._process.stdout:  # type: ignore[union-attr]
                if len(self._lines) < 100:
                    self._lines.append(line)
                if log is not None:
                    with contextlib.suppress(OSError):
                        # The log outlives the run, so it must not contain the token.
                        log.write(line.partition("?token=")[0].rstrip() + "\n")
