"""The cockpit beside a run: a process of its own, which ends with the one that has started it."""

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

# Where a page is served if nobody says.
FREE_PORT = "127.0.0.1:0"
URL, ERROR = "cockpit: http", "error: "
START_SECONDS, CLOSE_SECONDS, POLL_SECONDS = 120.0, 2.0, 0.02


class CockpitProcess:
    """Serves the page of the graph of ``ROS_MASTER_URI``, whose master may come later; logs to ``log``.

    ``tool``: that is open at first. ``prefix``: before its command, as that of a file system of its own.
    Raises PortError if it cannot be served at ``where``, [ADDRESS:]PORT, CockpitError if it does not start.
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
        """Ends it: every page is told that the connection is lost."""
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
        """Reads on whatever happens to the log, since a process stands still when nobody reads."""
        with contextlib.ExitStack() as stack:
            log = None
            with contextlib.suppress(OSError):
                log = stack.enter_context(self._log.open("w", encoding="utf-8", buffering=1))
            for line in self._process.stdout:  # type: ignore[union-attr]
                if len(self._lines) < 100:
                    self._lines.append(line)
                if log is not None:
                    with contextlib.suppress(OSError):
                        # The log stays when the run is over: the token is for who started it.
                        log.write(line.partition("?token=")[0].rstrip() + "\n")
