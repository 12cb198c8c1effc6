#!/usr/bin/env python3
"""Measure navigation over ROS: the real-time factor, and CPU time and memory of each node.

Drive the robot through the home by scripts/test_navigation.sh, as fast as the nodes keep up:

    python3 tests/benchmarks/graph.py [--laps 3] [--seed 3] [--json FILE]
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Dict

import psutil

ROOT = Path(__file__).resolve().parents[2]
LAP = "2.0 3.0 0.0; -2.0 1.0 3.14; "
PERIOD_SECONDS, START_SECONDS = 0.3, 300.0
NODE = re.compile(r"__name:=(\w+)")


class NodeMeter:
    """Measures CPU time since ``start`` [s] and peak memory [MB] of every ROS node below a process."""

    def __init__(self, parent: psutil.Process):
        self._parent = parent
        # By process, as a node may have several, and some end early.
        self._nodes: Dict[int, str] = {}
        self._cpu: Dict[int, float] = {}
        self._before: Dict[int, float] = {}
        self.memory: Dict[str, float] = {}

    def start(self) -> None:
        self.sample()
        self._before = dict(self._cpu)

    def sample(self) -> None:
        """Read CPU time and memory of all nodes."""
        for process in self._parent.children(recursive=True):
            try:
                match = NODE.search(" ".join(process.cmdline()))
                if match is None:
                    continue
                name, times = match[1], process.cpu_times()
                self._nodes[process.pid] = name
                self._cpu[process.pid] = max(self._cpu.get(process.pid, 0.0), times.user + times.system)
                self.memory[name] = max(self.memory.get(name, 0.0), process.memory_info().rss / 2**20)
            except psutil.Error:
                continue

    def cpu_since_start(self) -> Dict[str, float]:
        used: Dict[str, float] = {}
        for process, seconds in self._cpu.items():
            name = self._nodes[process]
            used[name] = used.get(name, 0.0) + seconds - self._before.get(process, 0.0)
        return used


def main() -> int:
    options = _options()
    with tempfile.TemporaryDirectory() as folder:
        meter = _drive(options, folder)
        result = json.loads(next(Path(folder).glob("*/result.json")).read_text(encoding="utf-8"))
    cpu = meter.cpu_since_start()
    print(f"\n{result['real_time_factor']:.2f} x real time\n{'node':24} CPU s after goal 1    MB")
    for name in sorted(cpu, key=cpu.__getitem__, reverse=True):
        print(f"{name:24} {cpu[name]:18.1f} {meter.memory[name]:5.0f}")
    if options.json:
        figures = {"real_time_factor": result["real_time_factor"], "cpu": cpu, "memory_mb": meter.memory}
        options.json.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")
    return 0 if result["success"] else 1


def _drive(options, folder: str) -> NodeMeter:
    """Print the output of the run, and measure its nodes from the first goal on."""
    command = [str(ROOT / "scripts" / "test_navigation.sh"), "--output", folder]
    command += ["--seed", str(options.seed), "--goals", options.laps * LAP]
    run = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    meter, has_started = NodeMeter(psutil.Process(run.pid)), threading.Event()

    def show() -> None:
        assert run.stdout is not None
        for line in run.stdout:
            print(line, end="", flush=True)
            if line.startswith("goal 1"):
                has_started.set()

    threading.Thread(target=show, daemon=True).start()
    has_started.wait(START_SECONDS)
    meter.start()
    while run.poll() is None:
        meter.sample()
        time.sleep(PERIOD_SECONDS)
    if run.returncode == 2:
        raise SystemExit(2)
    return meter


def _options():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--laps", type=int, default=3, help="to the kitchen and back (%(default)s)")
    parser.add_argument("--seed", type=int, default=3, help="of every noise (%(default)s)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="writes the figures there too")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
