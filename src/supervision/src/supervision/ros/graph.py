"""A ROS graph of its own: a master on a free port and everything that a launch file starts."""

import contextlib
import os
import re
import shutil
import signal
import subprocess
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Dict, Mapping, Optional

import psutil

from supervision.errors import LaunchError
from supervision.processes import adopt_orphans, end_descendants, end_with_parent, free_port

SIGINT_SECONDS = 8.0
HEARING_SECONDS = 2.0
SIGTERM_SECONDS = 2.0
DIED = re.compile(r"(\[(?P<node>[^\]\[]+?)(-\d+)?\] )?process has died \[pid \d+, exit code (?P<code>-?\d+)")
# Of a node without which there is no run, the name stands in the line before.
REQUIRED = re.compile(r"REQUIRED process \[(?P<node>[^\]\[]+?)(-\d+)?\] has died")
POLL_SECONDS = 0.02
ENDING = "killing on exit"
COMPLAINT = re.compile(r"^\[/(?P<node>\S+)\] error: (?P<text>.*)")
BAD_INPUT = 2


@dataclass(frozen=True)
class NodeFailure:
    """A node that died with an error: its own words, if it had any, and whether it refused its input."""

    text: str
    is_bad_input: bool


class RosGraph:
    """Runs ``roslaunch`` under a master of its own; leaves no process behind when it is closed.

    What roslaunch prints, and each node on stderr, goes to ``log_folder``/roslaunch.log.
    """

    def __init__(self, package: str, launch_file: str, arguments: Mapping[str, object], log_folder: Path):
        self._complaints: Dict[str, str] = {}
        self._required = "a node"
        self._failure: Optional[NodeFailure] = None
        self.log_gap: Optional[str] = None
        self._log_folder = log_folder
        adopt_orphans()
        port = free_port()
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
        os.environ["ROS_LOG_DIR"] = str(log_folder)
        command = ["roslaunch", "--port", str(port), package, launch_file]
        command += [f"{name}:={value}" for name, value in arguments.items() if value is not None]
        if shutil.which("roslaunch") is None:
            raise LaunchError("roslaunch is not on the PATH: run scripts/setup.sh")
        self._roslaunch = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            preexec_fn=end_with_parent,
            text=True,
            errors="replace",
        )
        self._is_ending = threading.Event()
        self._pump = threading.Thread(target=self._read_output, daemon=True)
        self._pump.start()

    @property
    def is_running(self) -> bool:
        return self._roslaunch.poll() is None

    @property
    def failure(self) -> Optional[NodeFailure]:
        """The first node that died with an error; None if none did."""
        return self._failure

    def close(self) -> None:
        """Ends every process of the graph: SIGINT first, then SIGTERM, then SIGKILL."""
        if self.is_running:
            self._roslaunch.send_signal(signal.SIGINT)
        self._wait_for_roslaunch()
        end_descendants(SIGTERM_SECONDS)
        self._pump.join(1.0)

    def _wait_for_roslaunch(self) -> None:
        """Patiently while it ends nodes: it may not hear before it has any, and stay on after the last."""
        started = time.monotonic()
        while self.is_running:
            ends_nodes = self._is_ending.is_set() and psutil.Process(self._roslaunch.pid).children()
            if time.monotonic() - started > (SIGINT_SECONDS if ends_nodes else HEARING_SECONDS):
                return
            time.sleep(POLL_SECONDS)

    def _read_output(self) -> None:
        """Reads on whatever happens to the log, since roslaunch stands still when nobody reads."""
        log: Optional[IO[str]] = None
        with contextlib.suppress(OSError):
            log = (self._log_folder / "roslaunch.log").open("w", encoding="utf-8", buffering=1)
        for line in self._roslaunch.stdout:  # type: ignore[union-attr]
            self._notice(line)
            if log is not None:
                try:
                    log.write(line)
                except OSError as error:
                    self.log_gap = f"log/roslaunch.log: {error.strerror}"
                    log = None
        self._is_ending.set()

    def _notice(self, line: str) -> None:
        if line.rstrip().endswith(ENDING):
            self._is_ending.set()
        complaint, required, death = COMPLAINT.match(line), REQUIRED.search(line), DIED.search(line)
        if complaint:
            self._complaints[complaint.group("node")] = complaint.group("text")
        if required:
            self._required = required.group("node")
        if death and self._failure is None:
            node, code = death.group("node") or self._required, int(death.group("code"))
            text = self._complaints.get(node, f"{_end_in_words(code)}, see {self._log_folder}")
            self._failure = NodeFailure(f"{node}: {text}", code == BAD_INPUT)


def _end_in_words(code: int) -> str:
    """What an exit code means; a negative one is a signal's number."""
    if code >= 0:
        return f"died with exit code {code}"
    with contextlib.suppress(ValueError):
        return f"was ended by {signal.Signals(-code).name}"
    return f"was ended by signal {-code}"
