#!/usr/bin/env python3
"""Check that a simulation with noise is the same to the last bit for a seed, in separate processes.

python3 tests/benchmarks/repeatability.py [--seconds 60] [--noise turtlebot] [--seeds 1 2] [--runs 2] [WORLD]
"""

import argparse
import hashlib
import math
import subprocess
import sys
from pathlib import Path

import numpy as np

from planar import PlanarError, Pose2, Twist2
from sim_bridge import Episode, Simulation, SimulationSettings, StepResult, load_world
from sim_bridge.noise import NOISE_PROFILES, noise_named

ROOT = Path(__file__).resolve().parents[2]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("world", nargs="?", metavar="WORLD", default=str(ROOT / "map" / "home.world"))
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated time (default: 60)")
    parser.add_argument(
        "--noise", default="turtlebot", help=f"{', '.join(NOISE_PROFILES)} (default: turtlebot)"
    )
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2], help="default: 1 2")
    parser.add_argument("--runs", type=int, default=2, help="processes for each seed (default: 2)")
    parser.add_argument("--only", type=int, metavar="SEED", help="prints the hash of one run in this process")
    options = parser.parse_args()
    try:
        if options.only is not None:
            print(fingerprint(options.world, options.only, options.noise, options.seconds))
            return 0
        hashes = {
            seed: [in_fresh_process(options, seed) for _ in range(options.runs)] for seed in options.seeds
        }
    except PlanarError as error:
        sys.exit(f"repeatability.py: error: {error}")
    for seed, found in hashes.items():
        print(f"seed {seed}: {' '.join(found)}")
    same = all(len(set(found)) == 1 for found in hashes.values())
    different = len({found[0] for found in hashes.values()}) == len(hashes)
    print(f"same seed, same hash: {same}; different seed, different hash: {different}")
    return 0 if same and different else 1


def in_fresh_process(options: argparse.Namespace, seed: int) -> str:
    command = [sys.executable, __file__, options.world, "--only", str(seed)]
    command += ["--seconds", str(options.seconds), "--noise", options.noise]
    run = subprocess.run(command, capture_output=True, text=True, timeout=600.0)
    if run.returncode:
        sys.exit(run.stderr.strip())
    return run.stdout.strip()


def fingerprint(path: str, seed: int, noise: str, seconds: float) -> str:
    """Return a hash of all measurements of a robot that pushes a box through the world in curves."""
    settings = SimulationSettings(**noise_named(noise))
    simulation = Simulation(load_world(path), settings=settings, seed=seed)
    simulation.add_box("crate", (0.3, 0.3, 0.3), Pose2(0.6, 0.0, 0.3), mass=0.5)
    digest, episode = hashlib.sha256(), Episode(simulation, simulation.step_seconds)
    for step in range(round(seconds / simulation.step_seconds)):
        command = Twist2(0.3, 0.8 * math.sin(0.5 * step * simulation.step_seconds))
        feed(digest, episode.step(command))
    simulation.close()
    return digest.hexdigest()[:16]


def feed(digest, seen: StepResult) -> None:
    base, odom, twist = seen.base_in_world, seen.odometry.base_in_odom, seen.odometry.twist
    numbers = (seen.stamp, base.x, base.y, base.yaw, odom.x, odom.y, odom.yaw, twist.v, twist.omega)
    digest.update(np.array([*numbers, *seen.wheel_angles, *seen.wheel_speeds, seen.tilt]).tobytes())
    digest.update("\n".join(seen.contacts).encode())
    for scan in seen.scans:
        if scan is not None:
            digest.update(scan.ranges.tobytes() + scan.intensities.tobytes())


if __name__ == "__main__":
    sys.exit(main())
