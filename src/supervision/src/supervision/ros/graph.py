"""A ROS graph of its own: a master on a free port and everything that a launch file starts."""

import contextlib
import os
import random
import shutil
import signal
import socket
import subprocess
import threading
import time
from pathlib import Path
from typing import IO, Collection, List, Mapping, Optional

import psutil

from supervision.errors import LaunchError
from supervision.guard import guarded, ignore_ctrl_c
from supervision.node_exits import NodeExits, describe_exit
from supervision.processes import SIGTERM_SECONDS, adopt_orphans, end_descendants

SIGINT_SECONDS = 8.0
HEARING_SECONDS = 2.0
CORE = ("roslaunch", "rosmaster", "rosout")
CORE_SECONDS = 0.1
POLL_SECONDS = 0.02
ENDING = "killing on exit"
FIRST_PORT, FIRST_OUTGOING_PORT = 20000, 32768


class RosGraph:
    """Runs ``roslaunch`` under a master of its own; leaves no process behind when it is closed, or killed.

    What roslaunch prints, and each node on stderr, goes to ``log_folder``/roslaunch.log. ``deaths``: of
    nodes; those in ``comes_back`` the launch file has started again.
    """

    def __init__(
        self,
        package: str,
        launch_file: str,
        arguments: Mapping[str, object],
        log_folder: Path,
        respawned: Collection[str] = (),
    ):
        self.exits = NodeExits(log_folder, respawned)
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
            guarded(command),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            preexec_fn=ignore_ctrl_c,
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
    def how_it_ended(self) -> str:
        """Of roslaunch, once it does not run any more."""
        code = self._roslaunch.poll() or 0
        return describe_exit(code) if code < 0 else "ended"

    def close(self) -> None:
        """Ends every process of the graph: SIGINT first, then SIGTERM, then SIGKILL."""
        if self.is_running:
            os.killpg(self._roslaunch.pid, signal.SIGINT)
        self._wait_for_roslaunch()
        end_descendants(SIGTERM_SECONDS if self._nodes() else CORE_SECONDS)
        self._pump.join(1.0)

    def _wait_for_roslaunch(self) -> None:
        """Patiently while it ends nodes; it may not hear before it has any."""
        started = time.monotonic()
        while self.is_running:
            ends_nodes = self._is_ending.is_set() and bool(self._nodes())
            is_done = self._is_ending.is_set() and not ends_nodes
            if is_done or time.monotonic() - started > (SIGINT_SECONDS if ends_nodes else HEARING_SECONDS):
                return
            time.sleep(POLL_SECONDS)

    def _nodes(self) -> List[psutil.Process]:
        """What roslaunch has started, but for its master and rosout, which have nothing to finish."""
        nodes = []
        with contextlib.suppress(psutil.NoSuchProcess):
            for process in psutil.Process(self._roslaunch.pid).children(recursive=True):
                with contextlib.suppress(psutil.NoSuchProcess):
                    words = process.cmdline()
                    if words and not any(Path(word).name in CORE for word in words[:2]):
                        nodes.append(process)
        return nodes

    def _read_output(self) -> None:
        """Reads on whatever happens to the log, since roslaunch stands still when nobody reads."""
        log: Optional[IO[str]] = None
        with contextlib.suppress(OSError):
            log = (self._log_folder / "roslaunch.log").open("w", encoding="utf-8", buffering=1)
        for line in self._roslaunch.stdout:  # type: ignore[union-attr]
            self.exits.read(line)
            if line.rstrip().endswith(ENDING):
                self._is_ending.set()
            if log is not None:
                try:
                    log.write(line)
                except OSError as error:
                    self.log_gap = f"log/roslaunch.log: cannot be written ({error.strerror})"
                    log = None
        self._is_ending.set()


def free_port() -> int:
    """A TCP port on the loopback interface that nobody listens on right now.

    It lies below those that the system hands out for outgoing connections: one of these, of another graph for
    example, might take it before a master listens there.
    """
    ports = range(FIRST_PORT, FIRST_OUTGOING_PORT)
    for port in random.Random().sample(ports, len(ports)):
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return port
    raise LaunchError(f"every port from {ports[0]} to {ports[-1]} is in use")
