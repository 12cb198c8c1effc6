#!/usr/bin/env python3
"""Localization of amcl_lite, and of the official amcl where it is installed, on logs of real robots.

Each node gets all scans and the odometry of a log, with default parameters, in a map of the same log: made by
slam_lite, or rendered from a file of true poses. The start is known to amcl's initial covariance. A scan is
lost if the position is off by more than 0.5 m from that of the map's trajectory. The laser has to be mounted
alike in all logs.

    tests/benchmarks/localization_logs.py LOG.bag... [--map slam|truth] [--runs 3]

``--map truth`` needs the poses in LOG.truth, a row ``stamp x y yaw`` for each scan [s, m, m, rad].
"""

import argparse
import sys
from pathlib import Path
from typing import Dict, List, Tuple

import numpy as np
from helpers.drives import Observation
from helpers.localization_cases import FRAMES, installed_nodes
from helpers.lockstep import Master, Player

from planar import OccupancyGrid, Pose2, wrap
from planar.geometry.no_return import NoReturnDetector
from planar_ros.bags.scan_log import LoggedScan, ScanLog
from slam_lite.config import MapperSettings
from slam_lite.mapper import Mapper, ranges_of
from slam_lite.rendering import Evidence, beams_of, render_in_bands
from slam_lite.scan_trajectory import ScanTrajectory

PORT = 11397
LOST_BEYOND = 0.5


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("logs", nargs="+", type=Path, metavar="LOG.bag")
    parser.add_argument("--map", choices=("slam", "truth"), default="slam", help="(%(default)s)")
    parser.add_argument("--runs", type=int, default=3, help="of each node, with seeds from 0 (%(default)s)")
    options = parser.parse_args()
    commands = installed_nodes()
    lost: Dict[str, List[float]] = {name: [] for name in commands}
    print("log                  map    node       run   lost %  median m    95 % m  heading rad  CPU ms/scan")
    master, player = Master(PORT), None
    try:
        for path in options.logs:
            scans = list(ScanLog(path, "/scan", "base_link", "odom", warn))
            grid, poses = mapped(scans) if options.map == "slam" else rendered(scans, path)
            drive = observations(scans, poses)
            player = player or Player(grid, drive[0].scan.laser_in_base)
            player.use_map(grid)
            for name, command in commands.items():
                for seed in range(options.runs):
                    errors, cpu = measure(player, command, drive, seed)
                    lost[name].append(100.0 * float(np.mean(errors[:, 0] > LOST_BEYOND)))
                    label = f"{path.stem:20} {options.map:6} {name:10} {seed:3}"
                    middle, far = np.percentile(errors[:, 0], (50, 95))
                    angle = np.median(errors[:, 1])
                    figures = (
                        f"{lost[name][-1]:8.1f} {middle:9.3f} {far:9.3f} {angle:12.4f} {1e3 * cpu:12.2f}"
                    )
                    print(label, figures, flush=True)
    finally:
        master.close()
    for name, shares in lost.items():
        print(f"mean of all runs: {name:10} {np.mean(shares):.1f} % lost")
    return 0


def warn(text: str) -> None:
    print(f"warning: {text}", file=sys.stderr)


def mapped(scans: List[LoggedScan]) -> Tuple[OccupancyGrid, np.ndarray]:
    """Return the map of slam_lite and the poses (N, 3) of the base in it."""
    mapper, trajectory = Mapper(), ScanTrajectory()
    for logged in scans:
        update = mapper.insert(logged.base_in_odom, logged.scan)
        trajectory.add(logged.base_in_odom, logged.scan, update)
    mapper.run_final_optimization()
    return mapper.grid(), trajectory.poses(mapper.keyframe_poses)[:, 1:]


def rendered(scans: List[LoggedScan], path: Path) -> Tuple[OccupancyGrid, np.ndarray]:
    """Return the map at the true poses, and these (N, 3)."""
    truth = np.loadtxt(path.with_suffix(".truth"))
    poses = np.array([truth[np.argmin(np.abs(truth[:, 0] - one.scan.stamp)), 1:4] for one in scans])
    detector, settings = NoReturnDetector(), MapperSettings()
    for logged in scans:
        detector.add(logged.scan.ranges)
    beams = [beams_of(one.scan, *ranges_of(one.scan, settings, detector)) for one in scans]
    bands = render_in_bands(Evidence(beams, poses), settings.resolution, settings.occupied_threshold)
    return bands.assemble(), poses


def observations(scans: List[LoggedScan], poses: np.ndarray) -> List[Observation]:
    """Return the drive that the player shows."""
    return [
        Observation(one.scan, one.base_in_odom, Pose2.from_array(pose)) for one, pose in zip(scans, poses)
    ]


def measure(player: Player, command: str, drive: List[Observation], seed: int) -> Tuple[np.ndarray, float]:
    """Errors (N, 2) of position [m] and heading [rad] after each scan, and CPU seconds a scan."""
    start = drive[0].base_in_map
    initial = {f"initial_pose_{axis}": value for axis, value in zip("xya", start.as_array().tolist())}
    node = player.start_node([command], {**FRAMES, **initial, "seed": seed})
    try:
        player.wake(drive[0])
        begin, errors, odom_in_map = node.cpu_seconds(), [], None
        for last, observation in zip([drive[0], *drive], drive):
            period = max(observation.scan.stamp - last.scan.stamp, 0.1)
            odom_in_map = player.show(observation, period=period) or odom_in_map
            found = Pose2() if odom_in_map is None else odom_in_map @ observation.base_in_odom
            true = observation.base_in_map
            errors.append((found.distance_to(true), abs(wrap(found.yaw - true.yaw))))
        return np.array(errors), (node.cpu_seconds() - begin) / len(drive)
    finally:
        node.close()


if __name__ == "__main__":
    sys.exit(main())
