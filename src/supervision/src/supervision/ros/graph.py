"""A ROS graph with a separate master on a free port."""

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
REACTION_SECONDS = 2.0
CORE = ("roslaunch", "rosmaster", "rosout")
CORE_SECONDS = 0.1
POLL_SECONDS = 0.02
ENDING = "killing on exit"
FIRST_PORT, FIRST_OUTGOING_PORT = 20000, 32768


class RosGraph:
    """Runs ``roslaunch`` with a separate master; no process is left when it is closed or killed.

    The output of roslaunch, and of each node on stderr, goes to ``log_folder``/roslaunch.log.

    Args:
        package: Package of the launch file.
        launch_file: Name of the launch file.
        arguments: Its arguments; those of None are left out.
        log_folder: Folder of the logs.
        respawned: Nodes that the launch file restarts.

    Attributes:
        exits: Exits of nodes.
        log_gap: Why the log is incomplete; None if it is complete.

    Raises:
        LaunchError: If roslaunch is not installed or no port is free.
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
        """How roslaunch has ended, in words."""
        code = self._roslaunch.poll() or 0
        return describe_exit(code) if code < 0 else "ended"

    def close(self) -> None:
        """End every process of the graph by SIGINT, SIGTERM and SIGKILL in turn."""
        if self.is_running:
            os.killpg(self._roslaunch.pid, signal.SIGINT)
        self._wait_for_roslaunch()
        end_descendants(SIGTERM_SECONDS if self._nodes() else CORE_SECONDS)
        self._pump.join(1.0)

    def _wait_for_roslaunch(self) -> None:
        """Wait longer while roslaunch ends nodes; before it has any it may miss the signal."""
        started = time.monotonic()
        while self.is_running:
            ends_nodes = self._is_ending.is_set() and bool(self._nodes())
            is_done = self._is_ending.is_set() and not ends_nodes
            if is_done or time.monotonic() - started > (SIGINT_SECONDS if ends_nodes else REACTION_SECONDS):
                return
            time.sleep(POLL_SECONDS)

    def _nodes(self) -> List[psutil.Process]:
        """Return the processes of nodes, without master and rosout, which need no time to end."""
        nodes = []
        with contextlib.suppress(psutil.NoSuchProcess):
            for process in psutil.Process(self._roslaunch.pid).children(recursive=True):
                with contextlib.suppress(psutil.NoSuchProcess):
                    words = process.cmdline()
                    if words and not any(Path(word).name in CORE for word in words[:2]):
                        nodes.append(process)
        return nodes

    def _read_output(self) -> None:
        """Read the output even if the log cannot be written, since roslaunch blocks if its pipe is full."""
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
    """Return a free TCP port on the loopback interface.

    It is below the ports for outgoing connections, one of which might be taken before the master listens.

    Raises:
        LaunchError: If no port is free.
    """
    ports = range(FIRST_PORT, FIRST_OUTGOING_PORT)
    for port in random.Random().sample(ports, len(ports)):
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return port
    raise LaunchError(f"every port from {ports[0]} to {ports[-1]} is in use")
