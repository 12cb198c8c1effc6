#!/usr/bin/env python3
"""Measure the real-time factor of the simulation without ROS, on one core.

python3 tests/benchmarks/simulation.py [--seconds 60] [--json FILE] [WORLD ...]
"""

import argparse
import json
import resource
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path

from planar import PlanarError, Twist2
from sim_bridge import ROBOTS, Episode, RobotProfile, Simulation, load_world
from sim_bridge.world import World

ROOT = Path(__file__).resolve().parents[2]
# A circle that stays clear of the home's furniture.
COMMAND = Twist2(0.2, 0.5)
HEADING = "world                robot              bodies  load s start s  x real   x CPU    MB"


@dataclass(frozen=True)
class Measurement:
    """Times [s], and simulated seconds per second of wall and CPU time."""

    world: str
    robot: str
    bodies: int
    load_seconds: float
    start_seconds: float
    real_time_factor: float
    real_time_factor_cpu: float
    memory_mb: float


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("worlds", nargs="*", metavar="WORLD", default=[str(ROOT / "map" / "home.world")])
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated time (default: 60)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="also write the figures to this file")
    options = parser.parse_args()
    try:
        measured = [
            measure(path, robot, options.seconds) for path in options.worlds for robot in ROBOTS.values()
        ]
    except PlanarError as error:
        sys.exit(f"simulation.py: error: {error}")
    print(HEADING)
    for one in measured:
        print(
            f"{one.world:20} {one.robot:18} {one.bodies:6} {one.load_seconds:7.3f} {one.start_seconds:7.3f} "
            f"{one.real_time_factor:7.1f} {one.real_time_factor_cpu:7.1f} {one.memory_mb:5.0f}"
        )
    if options.json:
        options.json.write_text(json.dumps([asdict(one) for one in measured], indent=2) + "\n")
    return 0


def measure(path: str, robot: RobotProfile, seconds: float) -> Measurement:
    start = time.perf_counter()
    world = load_world(path)
    loaded = time.perf_counter()
    episode = _started(world, robot)
    started = time.perf_counter()
    cpu = time.process_time()
    for _ in range(round(seconds / episode.simulation.step_seconds)):
        episode.step(COMMAND)
    wall, cpu = time.perf_counter() - started, time.process_time() - cpu
    episode.simulation.close()
    return Measurement(
        world=Path(path).name,
        robot=robot.name,
        bodies=len(world.bodies),
        load_seconds=loaded - start,
        start_seconds=started - loaded,
        real_time_factor=seconds / wall,
        real_time_factor_cpu=seconds / cpu,
        memory_mb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
    )


def _started(world: World, robot: RobotProfile) -> Episode:
    """Return an episode with the first scan taken, so that nothing is compiled while it is measured."""
    simulation = Simulation(world, robot)
    episode = Episode(simulation, simulation.step_seconds)
    for _ in range(10):
        episode.step()
    return episode


if __name__ == "__main__":
    sys.exit(main())
