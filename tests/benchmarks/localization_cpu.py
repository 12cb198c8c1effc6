#!/usr/bin/env python3
"""CPU time of amcl_lite, and of the official amcl where it is installed, over bags played at real time.

All run at the same time, each with its own master, map server and player. The bags hold odometry
at 50 Hz and scans at 10 Hz, and the clock comes at 50 Hz, all as from sim_bridge. What a node takes to start,
once, is listed beside, as the mean over all starts.

    tests/benchmarks/localization_cpu.py [--seconds 60]
"""

import argparse
import itertools
import os
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Callable

import rosgraph
from helpers.bags import write_bag
from helpers.drives import random_drive
from helpers.localization_cases import NOISES, PARAMETERS, installed_nodes, places
from helpers.lockstep import Node

from planar.maps.map_file import save_map

FIRST_PORT = 11390
CLOCK_RATE = 50
FIRST_SEED = 300
# How long, wall seconds, a process may take to start, and what a player may take beyond the bag's length.
DEADLINE_SECONDS = 180.0
# Time for the player and the node to find each other before the bag starts, seconds.
CONNECTION_SECONDS = 3


class Stage:
    """A master, a map server, the node under test and the player of a bag; ``processes`` ends them."""

    def __init__(self, port: int, command: str, parameters: dict, map_file: Path, processes: ExitStack):
        uri = f"http://127.0.0.1:{port}"
        self._environment, self._processes = {**os.environ, "ROS_MASTER_URI": uri}, processes
        self._master = rosgraph.Master("/benchmark", uri)
        self._run("rosmaster", "--core", "-p", str(port))
        _wait_until(self._master.is_online)
        self._master.setParam("/use_sim_time", True)
        for name, value in parameters.items():
            self._master.setParam("/amcl/" + name, value)
        self._run("rosrun", "map_lite", "map_server", str(map_file))
        self._node = self._run(command, "__name:=amcl")

    def play(self, bag: Path) -> None:
        """Waits for the node, then plays."""
        _wait_until(lambda: "/scan" in dict(self._master.getSystemState()[1]))
        self.start_seconds = self._node.cpu_seconds()
        options = ("--quiet", "--clock", f"--hz={CLOCK_RATE}", f"--delay={CONNECTION_SECONDS}")
        self._player = self._run(
            "rosbag", "play", *options, str(bag), "--topics", "/scan", "/tf", "/tf_static"
        )

    def node_seconds(self, seconds: float) -> float:
        """The CPU time of the node while a bag of this length is played."""
        self._player.wait(seconds + DEADLINE_SECONDS)
        return self._node.cpu_seconds() - self.start_seconds

    def _run(self, *command: str) -> Node:
        node = Node(list(command), self._environment)
        self._processes.callback(node.close)
        return node


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=60.0, help="length of each bag (%(default)s)")
    seconds = parser.parse_args().seconds
    commands = installed_nodes()
    starts, bags = dict.fromkeys(commands, 0.0), dict.fromkeys(commands, 0.0)
    count = 0
    print(f"{'CPU s':35}", *(f"{name:>10}" for name in commands))
    with tempfile.TemporaryDirectory() as folder:
        for seed, (place, noise) in enumerate(itertools.product(places(), NOISES), FIRST_SEED):
            map_file, bag = save_map(place.grid, Path(folder) / place.name), Path(folder) / "drive.bag"
            drive = random_drive(
                place.world, place.grid, seed, seconds, settings=NOISES[noise], start=place.start
            )
            write_bag(str(bag), drive)
            for preset, parameters in PARAMETERS.items():
                with ExitStack() as processes:
                    stages = {
                        name: Stage(FIRST_PORT + i, command, parameters, map_file, processes)
                        for i, (name, command) in enumerate(commands.items())
                    }
                    for stage in stages.values():
                        stage.play(bag)
                    taken = {name: stage.node_seconds(seconds) for name, stage in stages.items()}
                for name, stage in stages.items():
                    starts[name] += stage.start_seconds
                    bags[name] += taken[name]
                count += 1
                _print_times(f"{place.name} {noise} {preset}", taken)
    _print_times("all bags", bags)
    _print_times("a start", {name: total / count for name, total in starts.items()})


def _print_times(what, seconds_of_nodes):
    print(f"{what:35}", *(f"{seconds:10.2f}" for seconds in seconds_of_nodes.values()), flush=True)


def _wait_until(is_so: Callable[[], bool]) -> None:
    deadline = time.monotonic() + DEADLINE_SECONDS
    while not is_so():
        if time.monotonic() > deadline:
            raise TimeoutError("a process does not start")
        time.sleep(0.1)


if __name__ == "__main__":
    main()
