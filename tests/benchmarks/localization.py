#!/usr/bin/env python3
"""Localization of amcl_lite, and of the official amcl where it is installed, on the same drives.

Both nodes get the same scans, odometry and parameters (those of the TurtleBot), scan by scan. Errors are
those of map -> odom at every scan, against the truth; CPU is that of the whole process.

    tests/benchmarks/localization.py [--drives 4] [--seconds 120]
"""

import argparse
import subprocess
from pathlib import Path
from typing import Dict, List, Optional

import numpy as np
import yaml
from drives import Sighting, random_drive
from lockstep import Master, Player

from planar import load_map, wrap
from sim_bridge import load_world

ROOT = Path(__file__).resolve().parents[2]
PORT = 11399


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--drives", type=int, default=4, help="how many drives (%(default)s)")
    parser.add_argument("--seconds", type=float, default=120.0, help="length of each (%(default)s)")
    arguments = parser.parse_args()
    grid = load_map(ROOT / "map/home.yaml")
    world = load_world(str(ROOT / "map/home.world"))
    drives = [random_drive(world, grid, seed, arguments.seconds) for seed in range(arguments.drives)]
    parameters = yaml.safe_load((ROOT / "src/amcl_lite/config/turtlebot.yaml").read_text())
    master = Master(PORT)
    try:
        player = Player(grid, drives[0][0].scan.laser_in_base)
        commands = {name: _executable(name) for name in ("amcl", "amcl_lite")}
        print(f"{'':10} mean m   rmse m   95 % m   max m    heading rmse   CPU ms/scan   MB")
        for name, command in commands.items():
            if command is None:
                print(f"{name:10} not installed")
                continue
            print(f"{name:10}", _row(_measure(player, [command], parameters, drives)))
    finally:
        master.close()


def _executable(package: str) -> Optional[str]:
    """The program of a package's node, named as the package; None if there is none on ROS_PACKAGE_PATH."""
    found = subprocess.run(
        ["catkin_find", "--first-only", package, package], stdout=subprocess.PIPE, check=False
    ).stdout.decode()
    candidates = [found.strip(), str(ROOT / "src" / package / "nodes" / package)]
    return next((path for path in candidates if path and Path(path).is_file()), None)


def _measure(player: Player, command: List[str], parameters: dict, drives: List[List[Sighting]]) -> Dict:
    node = player.start_node(command, parameters)
    try:
        player.wake(drives[0][0])
        cpu_before, errors = node.cpu_seconds(), []
        for drive in drives:
            player.set_pose(drive[0].base_in_map)
            for sighting in drive:
                odom_in_map = player.show(sighting)
                if odom_in_map is not None:
                    found, truth = odom_in_map @ sighting.base_in_odom, sighting.base_in_map
                    errors.append((found.distance_to(truth), abs(wrap(found.yaw - truth.yaw))))
        cpu = (node.cpu_seconds() - cpu_before) / sum(map(len, drives))
        return {"errors": np.array(errors), "cpu": cpu, "memory": node.resident_megabytes()}
    finally:
        node.close()


def _row(measured: Dict) -> str:
    positions, headings = measured["errors"].T
    figures = (
        positions.mean(),
        np.sqrt(np.mean(positions**2)),
        np.percentile(positions, 95),
        positions.max(),
        np.sqrt(np.mean(headings**2)),
        1e3 * measured["cpu"],
        measured["memory"],
    )
    return "{:7.4f}  {:7.4f}  {:7.4f}  {:7.4f}  {:13.4f}  {:12.2f}  {:3.0f}".format(*figures)


if __name__ == "__main__":
    main()
