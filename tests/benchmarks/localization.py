#!/usr/bin/env python3
"""Localization of amcl_lite, and of the official amcl where it is installed, on the same drives.

Both nodes get the same scans, odometry and parameters, scan by scan. Errors are those of map -> odom at every
scan, against the truth; CPU is that of the whole process.

    tests/benchmarks/localization.py [accuracy] [updates] [recovery] [memory] [--seconds 100] [--runs 100]
        [--seed 0]
"""

import argparse
import time
from typing import Dict, List, Optional, Tuple

import numpy as np
from helpers.drives import Observation, random_drive
from helpers.localization_cases import NOISES, PARAMETERS, TURTLEBOT, Place, installed_nodes, places
from helpers.lockstep import Master, Node, Player

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, wrap

PORT = 11399
SCANS_PER_SECOND = 10
# A distance, metres, that no robot drives.
NEVER = 1000.0
# A recovery has succeeded when the position has been right for so long, metres and scans; in time, seconds.
RECOVERED_WITHIN, RECOVERED_SCANS = 0.25, 20
DEADLINES = {"global": 30, "kidnapped": 30, "wrong by 1 m, 30 deg": 10}
SECTIONS = ("accuracy", "updates", "recovery", "memory")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "sections", nargs="*", metavar="SECTION", help=f"of {', '.join(SECTIONS)}; default: all"
    )
    parser.add_argument("--seconds", type=float, default=100.0, help="length of each drive (%(default)s)")
    parser.add_argument("--runs", type=int, default=100, help="of each kind of recovery (%(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="of the drives (%(default)s)")
    arguments = parser.parse_args()
    sections = arguments.sections or SECTIONS
    unknown = set(sections) - set(SECTIONS)
    if unknown:
        parser.error(f"no such section: {', '.join(sorted(unknown))}")
    home, *others = places()
    commands = installed_nodes()
    master = Master(PORT)
    try:
        first = random_drive(home.world, home.grid, 0, 10.0, start=home.start)
        player = Player(home.grid, first[0].scan.laser_in_base)
        if "accuracy" in sections:
            accuracy(player, commands, [home, *others], arguments.seconds, arguments.seed)
        if "updates" in sections:
            updates(player, commands, home)
        if "recovery" in sections:
            recovery(player, commands, home, arguments.runs, arguments.seed)
        if "memory" in sections:
            memory(player, commands, first)
    finally:
        master.close()


def accuracy(
    player: Player, commands: Dict[str, str], where: List[Place], seconds: float, first_seed: int
) -> None:
    """Errors and CPU of each drive: every world, noise and set of parameters."""
    print(
        "world    noise      parameters  node       rmse m   95 % m   max m    heading rmse  CPU ms/scan  "
        "rmse ratio"
    )
    drives = {
        (place.name, noise): random_drive(
            place.world, place.grid, seed, seconds, settings=settings, start=place.start
        )
        for seed, place in enumerate(where, first_seed)
        for noise, settings in NOISES.items()
    }
    errors_of_all: Dict[str, List[np.ndarray]] = {name: [] for name in commands}
    cpu_of_all: Dict[str, List[float]] = {name: [] for name in commands}
    for place in where:
        player.use_map(place.grid)
        for preset, parameters in PARAMETERS.items():
            for noise in NOISES:
                official_rmse = None
                for name, command in commands.items():
                    errors, cpu = _measure(player, command, parameters, drives[place.name, noise])
                    rmse = float(np.sqrt(np.mean(errors[:, 0] ** 2)))
                    official_rmse = rmse if name == "amcl" else official_rmse
                    ratio = f"{rmse / official_rmse:.2f}" if official_rmse else ""
                    label = f"{place.name:8} {noise:10} {preset:11} {name:10}"
                    print(label, _figures(errors, cpu), ratio, flush=True)
                    errors_of_all[name].append(errors)
                    cpu_of_all[name].append(cpu)
    for name in commands:
        label = f"{'all':8} {'':10} {'':11} {name:10}"
        print(label, _figures(np.concatenate(errors_of_all[name]), float(np.mean(cpu_of_all[name]))))


def updates(player: Player, commands: Dict[str, str], place: Place) -> None:
    """What an update takes with a fixed number of particles and 60 beams.

    That is what a scan takes which causes one, less what a scan takes which causes none.
    """
    drive = random_drive(place.world, place.grid, 7, 30.0, start=place.start)
    player.use_map(place.grid)
    print("particles  node       update ms: answer, CPU    whole scan ms: answer, CPU")
    for count in (500, 2000, 5000):
        for name, command in commands.items():
            working, idle = (
                _costs(player, command, {**TURTLEBOT, **_fixed(count, after)}, drive)
                for after in (0.0, NEVER)
            )
            difference = [work - rest for work, rest in zip(working, idle)]
            figures = "  ".join(f"{1e3 * seconds:10.2f}" for seconds in (*difference, *working))
            print(f"{count:9}  {name:10}   {figures}", flush=True)


def _fixed(count: int, distance: float) -> Dict[str, float]:
    """Parameters for a fixed number of particles and an update after ``distance``, metres or radians."""
    return {
        "min_particles": count,
        "max_particles": count,
        "update_min_d": distance,
        "update_min_a": min(distance, 2.0 * np.pi),
    }


def _costs(player: Player, command: str, parameters: dict, drive: List[Observation]) -> Tuple[float, float]:
    """Mean seconds a scan: from publishing it to the answer, and of CPU."""
    waiting: List[float] = []
    _, cpu = _measure(player, command, parameters, drive, waiting)
    return float(np.mean(waiting)), cpu


def recovery(player: Player, commands: Dict[str, str], place: Place, runs: int, seed: int) -> None:
    """The share of runs in which the position is right within the deadline of driving."""
    print("recovery               node       share of runs   median s")
    length = SCANS_PER_SECOND * max(DEADLINES.values())
    drives = [
        random_drive(place.world, place.grid, seed + 20 + i, 4 * length / SCANS_PER_SECOND, start=place.start)
        for i in range(4)
    ]
    player.use_map(place.grid)
    for kind, deadline in DEADLINES.items():
        for name, command in commands.items():
            took = []
            node = player.start_node([command], TURTLEBOT)
            try:
                player.wake(drives[0][0])
                for run in range(runs):
                    rng = np.random.default_rng(seed + run)
                    took.append(_recover(player, kind, drives, deadline, rng))
            finally:
                node.close()
            times = [seconds for seconds in took if seconds is not None]
            median = f"{np.median(times):6.1f}" if times else "     -"
            print(f"{kind:22} {name:10} {len(times):5} of {runs:<5} {median}", flush=True)


def _recover(player: Player, kind: str, drives, deadline: int, rng) -> Optional[float]:
    """Seconds until the position is right, and stays so; None if that takes longer than the deadline."""
    observations = _piece(drives, rng, deadline * SCANS_PER_SECOND)
    if kind == "global":
        player.show(observations[0])
        player.localize_globally()
    elif kind == "kidnapped":
        before = _piece(drives, rng, 5 * SCANS_PER_SECOND)
        player.set_pose(before[0].base_in_map)
        for observation in before:
            player.show(observation)
        # Odometry does not notice.
        jump = before[-1].base_in_odom @ observations[0].base_in_odom.inverse()
        observations = [Observation(s.scan, jump @ s.base_in_odom, s.base_in_map) for s in observations]
    else:
        bearing, side = rng.uniform(-np.pi, np.pi), rng.choice((-1.0, 1.0))
        off = Pose2(np.cos(bearing), np.sin(bearing), side * np.radians(30.0))
        player.show(observations[0])
        truth = observations[0].base_in_map
        player.set_pose(Pose2(truth.x + off.x, truth.y + off.y, truth.yaw + off.yaw))
    right = 0
    for i, observation in enumerate(observations):
        odom_in_map = player.show(observation)
        is_right = (
            odom_in_map is not None
            and (odom_in_map @ observation.base_in_odom).distance_to(observation.base_in_map)
            < RECOVERED_WITHIN
        )
        right = right + 1 if is_right else 0
        if right == RECOVERED_SCANS:
            return (i + 1 - RECOVERED_SCANS) / SCANS_PER_SECOND
    return None


def _piece(drives: List[List[Observation]], rng, length: int) -> List[Observation]:
    drive = drives[rng.integers(len(drives))]
    first = int(rng.integers(len(drive) - length))
    return drive[first : first + length]


def memory(player: Player, commands: Dict[str, str], drive: List[Observation]) -> None:
    """Resident memory with a map of 2000 x 2000 cells."""
    cells = np.full((2000, 2000), FREE, dtype=np.int8)
    cells[::40, ::40] = OCCUPIED
    player.use_map(OccupancyGrid(cells, 0.05, Pose2(-50.0, -50.0)))
    print("node       MB with a map of 2000 x 2000 cells")
    for name, command in commands.items():
        node = player.start_node([command], TURTLEBOT)
        try:
            player.wake(drive[0])
            for observation in drive:
                player.show(observation)
            print(f"{name:10} {node.resident_megabytes():5.0f}")
        finally:
            node.close()


def _measure(
    player: Player, command: str, parameters: dict, drive: List[Observation], waiting: Optional[list] = None
):
    """Errors (N, 2) of position and heading, and CPU seconds a scan; ``waiting`` gets the wall seconds."""
    node: Node = player.start_node([command], parameters)
    try:
        player.wake(drive[0])
        player.set_pose(drive[0].base_in_map)
        cpu_before, errors = node.cpu_seconds(), []
        for observation in drive:
            shown = time.monotonic()
            odom_in_map = player.show(observation)
            if odom_in_map is None:
                continue
            if waiting is not None:
                waiting.append(time.monotonic() - shown)
            found, truth = odom_in_map @ observation.base_in_odom, observation.base_in_map
            errors.append((found.distance_to(truth), abs(wrap(found.yaw - truth.yaw))))
        return np.array(errors), (node.cpu_seconds() - cpu_before) / len(drive)
    finally:
        node.close()


def _figures(errors: np.ndarray, cpu: float) -> str:
    positions, headings = errors.T
    rmse, heading_rmse = np.sqrt(np.mean(positions**2)), np.sqrt(np.mean(headings**2))
    return (
        f"{rmse:7.4f}  {np.percentile(positions, 95):7.4f}  {positions.max():7.4f}  {heading_rmse:12.4f}"
        f"  {1e3 * cpu:11.2f} "
    )


if __name__ == "__main__":
    main()
