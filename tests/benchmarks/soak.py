#!/usr/bin/env python3
"""Run many missions, starts and stops, or deliveries of one graph; report leftovers and growth of memory.

python3 tests/benchmarks/soak.py missions [--runs 20] [--seed 0]
python3 tests/benchmarks/soak.py starts [--runs 20]
python3 tests/benchmarks/soak.py serve [--runs 100]
"""

import argparse
import contextlib
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Dict, List, Sequence

import numpy as np
import psutil

from supervision.processes import adopt_orphans

ROOT = Path(__file__).resolve().parents[2]
SHARED_MEMORY = Path("/dev/shm")
RUNS = "runs"
RUN_SECONDS, UP_SECONDS, DOWN_SECONDS = 300.0, 90.0, 60.0
# Share of the first deliveries, which fill caches.
SETTLED = 0.1
MISSION = """
places: {here: {x: 0.0, y: 0.0}, there: {x: 0.9, y: 0.2}}
settings: {pickup_seconds: 0.2}
deliveries: [{object: cup, from: %s, to: %s}]
"""


class Leftovers:
    """Finds what graphs leave behind: processes, sockets, and files in temporary folders, shared memory."""

    def __init__(self) -> None:
        adopt_orphans()
        self._folder = tempfile.TemporaryDirectory()
        self._shared = set(SHARED_MEMORY.iterdir())
        self.environment = {**os.environ, "TMPDIR": self._folder.name, "PYTHONUNBUFFERED": "1"}

    def find(self) -> List[str]:
        """List what is left now; shared memory of other programs counts, too."""
        processes = psutil.Process().children(recursive=True)
        alive = [process for process in processes if process.status() != psutil.STATUS_ZOMBIE]
        sockets = [f"socket {each.laddr}" for process in alive for each in process.connections("inet")]
        temporary = (path for path in Path(self._folder.name).iterdir() if path.name != RUNS)
        files = [*temporary, *(set(SHARED_MEMORY.iterdir()) - self._shared)]
        return [f"process {process.pid}" for process in alive] + sockets + list(map(str, files))


class Graph:
    """A script that runs a graph: its output and its nodes."""

    def __init__(self, leftovers: Leftovers, *command: str):
        self._log = tempfile.NamedTemporaryFile("w+", prefix="soak")  # noqa: SIM115
        script, output = ROOT / "scripts" / command[0], Path(leftovers.environment["TMPDIR"]) / RUNS
        self.process = subprocess.Popen(
            [str(script), *command[1:], "--output", str(output)],
            env=leftovers.environment,
            stdin=subprocess.DEVNULL,
            stdout=self._log,
            stderr=subprocess.STDOUT,
        )

    @property
    def output(self) -> str:
        """Output so far."""
        return Path(self._log.name).read_text(errors="replace")

    def wait_for(self, pattern: str) -> str:
        """Return the first group of a pattern in the output; exit if it does not appear in time."""
        deadline = time.monotonic() + UP_SECONDS
        while time.monotonic() < deadline and self.process.poll() is None:
            found = re.search(pattern, self.output)
            if found:
                return found[1]
            time.sleep(0.05)
        output = self.output
        self.end()
        sys.exit(f"soak.py: no output like {pattern} within {UP_SECONDS:g} s\n{output}")

    def end(self) -> int:
        self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(DOWN_SECONDS)
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.wait()

    def memory(self) -> Dict[str, int]:
        """Return the anonymous memory of each process and of the script by name [bytes].

        Memory mapped from libraries is excluded, because whether it counts as shared varies.
        """
        found: Dict[str, int] = {}
        script = psutil.Process(self.process.pid)
        for process in (script, *script.children(recursive=True)):
            with contextlib.suppress(psutil.NoSuchProcess):
                name = name_of(process.cmdline())
                found[name] = found.get(name, 0) + _anonymous(process)
        return found


def _anonymous(process: psutil.Process) -> int:
    status = Path(f"/proc/{process.pid}/status")
    with contextlib.suppress(FileNotFoundError):
        match = re.search(r"RssAnon:\s+(\d+) kB", status.read_text())
        return int(match[1]) << 10 if match else 0  # a zombie has none
    raise psutil.NoSuchProcess(process.pid)


def name_of(words: Sequence[str]) -> str:
    """Return the name of a node, or of the module or program of a command line."""
    command = " ".join(words)
    node = re.search(r"__name:=(\S+)", command)
    if node:
        return node[1]
    programs = [word for word in words if not Path(word).name.startswith(("python", "bash", "-"))]
    return Path(programs[0]).name if programs else command


def missions(options: argparse.Namespace, leftovers: Leftovers) -> int:
    """Run missions one after the other, each with the next seed."""
    failures, left = [], []
    for seed in range(options.seed, options.seed + options.runs):
        graph = Graph(leftovers, "home_service.sh", "--seed", str(seed), "--timeout", str(RUN_SECONDS))
        code = graph.process.wait(RUN_SECONDS + DOWN_SECONDS)
        left += leftovers.find()
        if code:
            failures.append(seed)
            print(graph.output, flush=True)
        print(f"seed {seed}: exit code {code}, {len(left)} left over", flush=True)
    print(f"{options.runs - len(failures)} of {options.runs} succeeded; failed: {failures}; left: {left}")
    return int(bool(failures or left))


def starts(options: argparse.Namespace, leftovers: Leftovers) -> int:
    """Start the whole graph and end it by Ctrl-C."""
    codes, left = [], []
    for number in range(options.runs):
        graph = Graph(leftovers, "launch.sh")
        graph.wait_for(r"ROS_MASTER_URI=(\S+)")
        codes.append(graph.end())
        left += leftovers.find()
        print(f"start {number + 1}: exit code {codes[-1]}, {len(left)} left over", flush=True)
    print(f"{options.runs} starts and stops, exit codes {sorted(set(codes))}; left: {left}")
    return int(any(codes) or bool(left))


def serve(options: argparse.Namespace, leftovers: Leftovers) -> int:
    """Run deliveries with one graph, and measure the memory of each node."""
    graph = Graph(leftovers, "home_service.sh", "--serve", "--speed", "0")
    os.environ.update(ROS_MASTER_URI=graph.wait_for(r"ROS_MASTER_URI=(\S+)"), ROS_IP="127.0.0.1")
    memory, failures = [], 0
    for number in range(options.runs):
        failures += not _deliver(("here", "there") if number % 2 == 0 else ("there", "here"))
        memory.append(graph.memory())
        if number % 10 == 9:
            total = sum(memory[-1].values()) >> 20
            print(f"delivery {number + 1}: {failures} failed, {total} MB", flush=True)
    code = graph.end()
    for line in growth(memory):
        print(line)
    left = leftovers.find()
    print(f"{options.runs - failures} of {options.runs} delivered, exit code {code}; left: {left}")
    return int(bool(failures or code or left))


def _deliver(ends: Sequence[str]) -> bool:
    """Deliver with one client for all deliveries; return whether it succeeded."""
    import actionlib
    import rospy
    from actionlib_msgs.msg import GoalStatus
    from home_service_msgs.msg import DeliverAction, DeliverGoal

    from planar_ros.calls.actions import goal_is_over
    from rospy_transport.node import is_initialized

    if not is_initialized():
        rospy.init_node("soak", disable_signals=True)
        _deliver.client = actionlib.SimpleActionClient("deliver", DeliverAction)  # type: ignore[attr-defined]
        _deliver.client.wait_for_server()  # type: ignore[attr-defined]
    client = _deliver.client  # type: ignore[attr-defined]
    client.send_goal(DeliverGoal(mission=MISSION % tuple(ends)))
    deadline = time.monotonic() + RUN_SECONDS
    while not goal_is_over(client) and time.monotonic() < deadline:
        time.sleep(0.02)
    return bool(client.get_state() == GoalStatus.SUCCEEDED)


def growth(memory: Sequence[Dict[str, int]]) -> List[str]:
    """Fit a line to the memory of each node, and of all, after the first deliveries."""
    settled = memory[int(SETTLED * len(memory)) :]
    lines = []
    nodes = sorted(set.intersection(*map(set, settled))) if len(settled) > 2 else []
    series = {node: [seen[node] for seen in settled] for node in nodes}
    series["all"] = [sum(seen[node] for node in nodes) for seen in settled]
    for name, values in series.items():
        slope, start = np.polyfit(np.arange(len(values)), values, 1)
        share = 100.0 * slope * len(values) / max(start, 1.0)
        megabytes, each = start / 2**20, slope / 2**10
        lines.append(f"{name}: {megabytes:.1f} MB, {each:+.1f} kB a delivery, {share:+.1f} % in all")
    return lines


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("missions", "starts", "serve"))
    parser.add_argument("--runs", type=int, default=20, help="default: 20")
    parser.add_argument("--seed", type=int, default=0, help="the first of the missions (default: 0)")
    options = parser.parse_args()
    return {"missions": missions, "starts": starts, "serve": serve}[options.what](options, Leftovers())


if __name__ == "__main__":
    sys.exit(main())
