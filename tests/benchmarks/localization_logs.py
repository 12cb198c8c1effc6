#!/usr/bin/env python3
"""Localization of amcl_lite, and of amcl and als_ros where they are installed, on logs of real robots.

Each node gets all scans and the odometry of a log, with default parameters, in a map of the same log: made by
slam_lite, or rendered from a file of true poses. The start is known to amcl's initial covariance. A scan is
lost if the position is off by more than 0.5 m from that of the map's trajectory. The quality that a node
publishes is judged by the area under its ROC curve for "not lost". The laser has to be mounted alike in all
logs.

    tests/benchmarks/localization_logs.py LOG.bag... [--map slam|truth] [--runs 3] [--recovery]

With ``--recovery`` the pose is also set wrong, by 1 m and 30 degrees or to another place, eight times a log;
the robot is found when it is not lost in three scans in a row, of at most forty.

``--map truth`` needs the poses in LOG.truth, a row ``stamp x y yaw`` for each scan [s, m, m, rad].
"""

import argparse
import math
import sys
from pathlib import Path
from typing import Callable, Dict, List, Optional, Tuple, Union

import numpy as np
from helpers.drives import Observation
from helpers.localization_cases import installed_nodes
from helpers.localizers import AlsRos, Amcl, als_ros_program
from helpers.lockstep import Master, Player
from scipy.stats import rankdata

from planar import OccupancyGrid, Pose2, wrap
from planar.geometry.no_return import NoReturnDetector
from planar_ros.bags.scan_log import LoggedScan, ScanLog
from slam_lite.config import MapperSettings
from slam_lite.mapper import Mapper, ranges_of
from slam_lite.rendering import Evidence, beams_of, render_in_bands
from slam_lite.scan_trajectory import ScanTrajectory

PORT = 11397
LOST_BEYOND = 0.5
# Wrong poses of a log, scans in which the robot has to be found, and scans in a row that it is then not lost.
STARTS, WITHIN, IN_A_ROW = 8, 40, 3
WRONG_DISTANCE, WRONG_TURN, ELSEWHERE = 1.0, math.radians(30.0), 5.0

Localizer = Union[Amcl, AlsRos]
# Makes a node that starts at a pose, with a seed.
Start = Callable[[Player, OccupancyGrid, Pose2, int], Localizer]


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("logs", nargs="+", type=Path, metavar="LOG.bag")
    parser.add_argument("--map", choices=("slam", "truth"), default="slam", help="(%(default)s)")
    parser.add_argument("--runs", type=int, default=3, help="of each node, with seeds from 0 (%(default)s)")
    parser.add_argument("--recovery", action="store_true", help="set the pose wrong as well")
    options = parser.parse_args()
    starts = startable_nodes()
    lost: Dict[str, List[float]] = {name: [] for name in starts}
    print(
        "log                  map    node       run  lost % median m    95 % m  heading rad   quality  CPU ms"
    )
    master, player = Master(PORT), None
    try:
        for path in options.logs:
            scans = list(ScanLog(path, "/scan", "base_link", "odom", warn))
            grid, poses = mapped(scans) if options.map == "slam" else rendered(scans, path)
            drive = observations(scans, poses)
            player = player or Player(grid, drive[0].scan.laser_in_base)
            player.use_map(grid)
            for name, start in starts.items():
                for seed in range(options.runs):
                    node = start(player, grid, drive[0].base_in_map, seed)
                    try:
                        label = f"{path.stem:20} {options.map:6} {name:10} {seed:3}"
                        rows, cpu = measure(node, drive)
                        lost[name].append(print_tracking(label, rows, cpu))
                        if options.recovery:
                            print_recovery(node, drive, rows)
                    finally:
                        node.close()
    finally:
        master.close()
    for name, shares in lost.items():
        print(f"mean of all runs: {name:10} {np.mean(shares):.1f} % lost")
    return 0


def startable_nodes() -> Dict[str, Start]:
    """How to start each installed node."""

    def amcl(command: str) -> Start:
        return lambda player, grid, start, seed: Amcl(player, command, start, seed)

    nodes = {name: amcl(command) for name, command in installed_nodes().items()}
    program = als_ros_program()
    if program is not None:
        nodes["als_ros"] = lambda player, grid, start, seed: AlsRos(player, program, grid, start)
    return nodes


def print_tracking(label: str, rows: np.ndarray, cpu: float) -> float:
    """Print a row of the table, and return the share of lost scans [%]; ``rows`` as of ``measure``."""
    is_lost = rows[:, 0] > LOST_BEYOND
    middle, far = np.percentile(rows[:, 0], (50, 95))
    figures = (
        f"{100.0 * is_lost.mean():7.1f} {middle:8.3f} {far:9.3f} {np.median(rows[:, 1]):12.4f} "
        f"{area_under_roc(rows[:, 2], ~is_lost):9.3f} {1e3 * cpu:7.2f}"
    )
    print(label, figures, flush=True)
    return float(100.0 * is_lost.mean())


def print_recovery(node: Localizer, drive: List[Observation], tracked: np.ndarray) -> None:
    """Print how often and how soon the node finds the robot again, and the quality also over ``tracked``."""
    every = [tracked[:, [0, 2]]]
    for kind in ("wrong by 1 m, 30 deg", "elsewhere"):
        starts = np.linspace(5, len(drive) - WITHIN - 5, STARTS).astype(int).tolist()
        results = [recovered(node, drive, first, kind, number) for number, first in enumerate(starts)]
        found = [scans for scans, _ in results if scans is not None]
        every += [rows for _, rows in results]
        median = f"{np.median(found):.0f}" if found else "-"
        print(f"    {kind:22} {len(found)} of {STARTS} after {median} scans", flush=True)
    rows = np.concatenate(every)
    print(f"    quality over all {area_under_roc(rows[:, 1], rows[:, 0] <= LOST_BEYOND):.3f}", flush=True)


def recovered(
    node: Localizer, drive: List[Observation], first: int, kind: str, seed: int
) -> Tuple[Optional[int], np.ndarray]:
    """Number of scans until the robot is found, and position error and quality (N, 2) after each scan."""
    rng, true = np.random.default_rng(1000 + seed), drive[first].base_in_map
    node.show(drive[first], 0.5)
    if kind == "elsewhere":
        others = [each.base_in_map for each in drive if each.base_in_map.distance_to(true) > ELSEWHERE]
        node.set_pose(others[rng.integers(len(others))])
    else:
        bearing, side = rng.uniform(-math.pi, math.pi), rng.choice((-1.0, 1.0))
        x, y = (WRONG_DISTANCE * each for each in (math.cos(bearing), math.sin(bearing)))
        node.set_pose(Pose2(true.x + x, true.y + y, true.yaw + side * WRONG_TURN))
    rows: List[Tuple[float, float]] = []
    for last, each in zip(drive[max(first - 1, 0) :], drive[first : first + WITHIN]):
        found, quality = node.show(each, max(each.scan.stamp - last.scan.stamp, 0.1))
        rows.append((found.distance_to(each.base_in_map), quality))
        if len(rows) >= IN_A_ROW and max(error for error, _ in rows[-IN_A_ROW:]) <= LOST_BEYOND:
            return len(rows) - IN_A_ROW, np.array(rows)
    return None, np.array(rows)


def area_under_roc(quality: np.ndarray, is_right: np.ndarray) -> float:
    """Probability that a right pose has the higher quality than a wrong one; NaN without both."""
    known = ~np.isnan(quality)
    quality, is_right = quality[known], is_right[known]
    right, wrong = int(is_right.sum()), int((~is_right).sum())
    ranks = rankdata(quality)[is_right].sum() - right * (right + 1) / 2
    return float(ranks / (right * wrong)) if right and wrong else math.nan


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


def measure(node: Localizer, drive: List[Observation]) -> Tuple[np.ndarray, float]:
    """Error of position [m] and heading [rad] and quality, (N, 3), after each scan; CPU seconds a scan."""
    node.wake(drive[0])
    begin, rows = node.cpu_seconds(), []
    for last, observation in zip([drive[0], *drive], drive):
        found, quality = node.show(observation, max(observation.scan.stamp - last.scan.stamp, 0.1))
        true = observation.base_in_map
        rows.append((found.distance_to(true), abs(wrap(found.yaw - true.yaw)), quality))
    return np.array(rows), (node.cpu_seconds() - begin) / len(drive)


if __name__ == "__main__":
    sys.exit(main())
