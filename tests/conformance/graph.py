"""A node with an observer on a separate ROS master: what our and the official node do with one input."""

import contextlib
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from functools import lru_cache
from pathlib import Path
from typing import Any, Dict, List, Optional

HERE = Path(__file__).resolve().parent
START_SECONDS, OBSERVE_SECONDS = 20.0, 120.0
MASTER = "import rosmaster, sys; rosmaster.rosmaster_main(['rosmaster', '--core', '-p', sys.argv[1]])"
ELF = b"\x7fELF"


def our_node(module: str) -> List[str]:
    """Return the command of a node of this workspace.

    Args:
        module: Module with the function ``main``.
    """
    return [sys.executable, "-c", f"from {module} import main; main()"]


def official_node(package: str, name: str) -> Optional[List[str]]:
    """Return the command of an official node; None if it is not installed.

    Args:
        package: Package of the node.
        name: Name of its executable; scripts, such as those of this workspace, do not count.
    """
    for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep):
        path = Path(prefix) / "lib" / package / name
        if path.is_file() and path.read_bytes()[:4] == ELF:
            return [str(path)]
    return None


def observe(observer: str, command: List[str], **given: Any) -> Dict[str, Any]:
    """Run an observer, which starts a node, on a separate master.

    Args:
        observer: Name of a module of this folder; it reads JSON and prints JSON.
        command: Command of the node.
        given: What the observer is given; plain values.

    Returns:
        What it observed.
    """
    return dict(_observe(observer, json.dumps({"command": command, **given}, sort_keys=True)))


@lru_cache(maxsize=None)
def _observe(observer: str, given: str) -> Dict[str, Any]:
    folder = tempfile.mkdtemp()
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        port = unused.getsockname()[1]
    environment = {
        **os.environ,
        "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
        "ROS_IP": "127.0.0.1",
        "ROS_LOG_DIR": folder,
        "PYTHONPATH": os.pathsep.join([str(HERE), *sys.path]),
    }
    environment.pop("ROS_HOSTNAME", None)
    master = _start([sys.executable, "-c", MASTER, str(port)], environment, stdout=subprocess.DEVNULL)
    try:
        _await_port(port)
        watching = _start(
            [sys.executable, str(HERE / f"{observer}.py")],
            {**environment, "FOLDER": folder},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        try:
            output, _ = watching.communicate(given.encode(), timeout=OBSERVE_SECONDS)
        finally:
            _end(watching)
        assert watching.returncode == 0, f"{observer} failed for {given}: {output.decode()}"
        return json.loads(output.decode().splitlines()[-1])
    finally:
        _end(master)
        shutil.rmtree(folder, ignore_errors=True)


def _start(command: List[str], environment: Dict[str, str], **how: Any) -> "subprocess.Popen[bytes]":
    return subprocess.Popen(command, env=environment, start_new_session=True, **how)


def _end(process: "subprocess.Popen[bytes]") -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def _await_port(port: int) -> None:
    deadline = time.monotonic() + START_SECONDS
    while True:
        try:
            socket.create_connection(("127.0.0.1", port), 1.0).close()
            return
        except OSError:
            assert time.monotonic() < deadline, "the master does not start"
            time.sleep(0.05)
