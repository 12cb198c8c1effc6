#!/usr/bin/env python3
"""A running graph listens on no socket that another host can reach (docs/explanation/security.md)."""

import ipaddress
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import psutil
import rostest
from processes import marked_environment, processes_of

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/launch.sh"
EXIT_SECONDS = 20.0
# Debian's own, in C++: ROS's library for it has the server of every node listen on all interfaces.
OF_THE_SYSTEM = {"robot_state_publisher", "rosout"}


class SocketsTest(unittest.TestCase):
    def test_only_this_host_reaches_what_the_project_listens_on(self):
        mark, environment = marked_environment()
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.Popen(
                [str(SCRIPT), "--web", "--output", folder],
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                text=True,
            )
            if any("Ctrl-C closes it" in line for line in run.stdout):
                found = {each for process, _ in processes_of(mark) for each in _listening(process)}
            run.send_signal(signal.SIGINT)
            run.communicate(timeout=EXIT_SECONDS)
        for program, address, port in sorted(found):
            print(f"{address}:{port} {program}")
        self.assertLess({"rosmaster", "sim_bridge", "cockpit"}, {program for program, *_ in found})
        open_to_others = {
            program for program, address, _ in found if not ipaddress.ip_address(address).is_loopback
        }
        self.assertLessEqual(open_to_others, OF_THE_SYSTEM)


def _listening(process):
    """Program, address and port of each socket that a process is reached by."""
    try:
        words = process.cmdline()
        sockets = process.connections(kind="inet")
    except psutil.NoSuchProcess:  # one that has just ended
        return []
    return [
        (_program(words), socket.laddr.ip, socket.laddr.port)
        for socket in sockets
        if socket.status == psutil.CONN_LISTEN or (socket.type.name == "SOCK_DGRAM" and not socket.raddr)
    ]


def _program(words):
    """What a command line runs: a module, a script, or a binary."""
    if "-m" in words:
        return words[words.index("-m") + 1].split(".")[0]
    return next((Path(word).name for word in words if "python" not in Path(word).name), "python")


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "sockets", SocketsTest)
