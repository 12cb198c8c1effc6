"""A child process that serves a page and prints its URL."""

import contextlib
import os
import signal
import subprocess
import threading
import time
from pathlib import Path
from typing import List, Mapping, Optional, Sequence

from cockpit.errors import CockpitError, PortError
from supervision.processes import ending_with_parent

ERROR = "error: "
START_SECONDS, POLL_SECONDS, KEPT_LINES = 120.0, 0.02, 100


class PageProgram:
    """Starts a program that prints ``LABEL: URL`` once its page is served, or ``error: REASON``.

    It receives a signal when the thread that starts it ends; so that thread has to last as long as the page.

    Args:
        command: Program and arguments.
        label: Text before the URL.
        log: File for its output; None: none.
        environment: Environment variables; None to inherit them.
        ending: Signal that ends the program.
    """

    def __init__(
        self,
        command: Sequence[str],
        label: str,
        log: Optional[Path] = None,
        environment: Optional[Mapping[str, str]] = None,
        ending: signal.Signals = signal.SIGTERM,
    ):
        self._label, self._log, self._ending = f"{label}: http", log, ending
        self._lines: List[str] = []
        self._process = subprocess.Popen(
            list(command),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            env=None if environment is None else dict(environment),
            start_new_session=True,
            preexec_fn=ending_with_parent(ending),
        )
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()

    @property
    def is_running(self) -> bool:
        return self._process.poll() is None

    def printed_url(self) -> Optional[str]:
        """Return the URL of the page; None while it is not served yet.

        Raises:
            PortError: The program reports an error; its text is that of the program.
            CockpitError: It has ended.
        """
        has_ended = not self._reading.is_alive()
        for line in list(self._lines):
            if line.startswith(self._label):
                return line.partition(": ")[2].strip()
            if line.startswith(ERROR):
                raise PortError(line.partition(": ")[2].strip())
        if has_ended:
            last = next(
                (line.strip() for line in reversed(self._lines) if line.strip()), "it printed nothing"
            )
            raise CockpitError(f"{self._label.partition(':')[0]}: its page is not served ({last})")
        return None

    def wait_for_url(self, seconds: float = START_SECONDS) -> str:
        """Return the URL as soon as the page is served.

        Args:
            seconds: Longest time to wait [s].

        Raises:
            PortError: The program reports an error.
            CockpitError: It has ended, or does not serve the page in time; it is ended.
        """
        deadline = time.monotonic() + seconds
        try:
            while time.monotonic() < deadline:
                url = self.printed_url()
                if url is not None:
                    return url
                time.sleep(POLL_SECONDS)
            raise CockpitError(f"{self._label.partition(':')[0]}: no page within {seconds:g} s")
        except CockpitError:
            self.close()
            raise

    def close(self, seconds: float = 2.0) -> None:
        """End the program; after some seconds it is killed with all that it has started.

        Args:
            seconds: Time that it may take to end [s].
        """
        self._process.send_signal(self._ending)
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()

    def _read(self) -> None:
        """Read the output even if the log cannot be written: a full pipe would block the process."""
        with contextlib.ExitStack() as stack:
            log = None
            if self._log is not None:
                with contextlib.suppress(OSError):
                    log = stack.enter_context(self._log.open("w", encoding="utf-8", buffering=1))
            for line in self._process.stdout:  # type: ignore[union-attr]
                if len(self._lines) < KEPT_LINES:
                    self._lines.append(line)
                if log is not None:
                    with contextlib.suppress(OSError):
                        # The log outlives the run, so it must not contain the token.
                        log.write(line.partition("?token=")[0].rstrip() + "\n")
