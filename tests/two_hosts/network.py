"""Hosts as network namespaces of this machine: two with a link, or one isolated. Needs root."""

import ctypes
import os
import signal
import subprocess
import uuid
from pathlib import Path
from typing import List, Optional

CLONE_NEWNET = 0x40000000
MASTER_PORT = 11311


class Host:
    """A network namespace with one ``address``: of its end of the link, or of its loopback."""

    def __init__(self, name: str, address: str):
        self.name, self.address = name, address
        self._processes: List[subprocess.Popen] = []

    def environment(self, master: "Host") -> dict:
        """Environment variables for ROS on this host."""
        return {
            **os.environ,
            "ROS_MASTER_URI": f"http://{master.address}:{MASTER_PORT}",
            "ROS_IP": self.address,
        }

    def start(self, master: "Host", *command: str, folder: Optional[Path] = None) -> subprocess.Popen:
        """Start a program on this host, in ``folder`` or the current folder."""
        process = subprocess.Popen(
            ["ip", "netns", "exec", self.name, *command],
            env=self.environment(master),
            cwd=folder,
            start_new_session=True,
        )
        self._processes.append(process)
        return process

    def stop_all(self) -> None:
        """End the started programs in reverse order."""
        for process in reversed(self._processes):
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                try:
                    process.wait(20.0)
                except subprocess.TimeoutExpired:
                    os.killpg(process.pid, signal.SIGKILL)
                    process.wait()

    def enter(self) -> None:
        """Move this process, and threads that it starts later, to this host."""
        with Path("/var/run/netns", self.name).open("rb") as namespace:
            if ctypes.CDLL(None, use_errno=True).setns(namespace.fileno(), CLONE_NEWNET) != 0:
                raise OSError(ctypes.get_errno(), f"cannot enter {self.name}")


class IsolatedHost:
    """Context of a host that has only its loopback."""

    def __init__(self):
        self._host = Host(f"isolated{uuid.uuid4().hex[:6]}", "127.0.0.1")

    def __enter__(self) -> Host:
        _ip("netns", "add", self._host.name)
        _ip("-n", self._host.name, "link", "set", "lo", "up")
        return self._host

    def __exit__(self, *_) -> None:
        self._host.stop_all()
        _ip("netns", "delete", self._host.name)


class NetworkLink:
    """Context of two connected hosts: ``robot`` and ``desk``."""

    def __init__(self):
        number = uuid.uuid4().hex[:6]
        self.robot = Host(f"robot{number}", "10.77.0.1")
        self.desk = Host(f"desk{number}", "10.77.0.2")

    def __enter__(self) -> "NetworkLink":
        for host in (self.robot, self.desk):
            _ip("netns", "add", host.name)
        _ip(
            "link",
            "add",
            "cable",
            "netns",
            self.robot.name,
            "type",
            "veth",
            "peer",
            "name",
            "cable",
            "netns",
            self.desk.name,
        )
        for host in (self.robot, self.desk):
            _ip("-n", host.name, "addr", "add", f"{host.address}/24", "dev", "cable")
            for device in ("lo", "cable"):
                _ip("-n", host.name, "link", "set", device, "up")
        return self

    def __exit__(self, *_) -> None:
        for host in (self.desk, self.robot):
            host.stop_all()
            _ip("netns", "delete", host.name)

    def disconnect(self) -> None:
        """Take the link down."""
        _ip("-n", self.desk.name, "link", "set", "cable", "down")

    def reconnect(self) -> None:
        _ip("-n", self.desk.name, "link", "set", "cable", "up")


def routes_of(host: Host) -> str:
    """Output of ``ip route`` on a host."""
    command = ["ip", "-n", host.name, "route"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def _ip(*arguments: str) -> None:
    subprocess.run(["ip", *arguments], check=True)
