#!/usr/bin/env python3
"""Let a localized robot stand, and measure how far its body, odometry and estimate move.

python3 tests/benchmarks/standing.py [--hours 24] [--robot turtlebot_lidar] [--noise turtlebot] [--seed 0]

Exit code 1 if one of them moves by more than 0.05 m or 1 degree.
"""

import argparse
import math
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator

import numpy as np

from amcl_lite import Localizer, LocalizerSettings
from planar import Pose2, Twist2, load_map, wrap
from planar.config.parameters import settings_from_yaml
from sim_bridge import ROBOTS, Episode, Simulation, SimulationSettings, StepResult, load_world
from sim_bridge.noise import NOISE_PROFILES, noise_named

ROOT = Path(__file__).resolve().parents[2]
LOCALIZATION_CONFIG = ROOT / "src" / "amcl_lite" / "config" / "turtlebot.yaml"
MAX_DISTANCE, MAX_DEGREES = 0.05, 1.0
# A turn on the spot before the robot stands, and the time in which it settles [s].
TURN_SECONDS, SETTLING_SECONDS = 6.0, 30.0
LINES = 24


@dataclass
class Deviation:
    """Largest distance [m] and angle [deg] between two poses so far."""

    distance: float = 0.0
    degrees: float = 0.0

    def add(self, first: Pose2, second: Pose2) -> None:
        self.distance = max(self.distance, first.distance_to(second))
        self.degrees = max(self.degrees, math.degrees(abs(wrap(first.yaw - second.yaw))))

    @property
    def is_small(self) -> bool:
        return self.distance <= MAX_DISTANCE and self.degrees <= MAX_DEGREES

    def __str__(self) -> str:
        return f"{self.distance:9.5f} m {self.degrees:8.4f} deg"


class LocalizedRobot:
    """A simulated robot that is localized in the home, without ROS."""

    def __init__(self, robot: str, noise: str, seed: int):
        world = load_world(ROOT / "map" / "home.world")
        simulation = Simulation(world, ROBOTS[robot], SimulationSettings(**noise_named(noise)), seed)
        self._episode = Episode(simulation, simulation.step_seconds)
        settings, _ = settings_from_yaml(LocalizerSettings, LOCALIZATION_CONFIG)
        grid = load_map(ROOT / "map" / "home.yaml")
        self._localizer = Localizer(grid, settings, np.random.default_rng(seed))

    def run(self, seconds: float, command: Twist2 = Twist2()) -> Iterator[StepResult]:
        """Simulate for some time; yield each step."""
        for _ in range(round(seconds / self._episode.simulation.step_seconds)):
            result = self._episode.step(command)
            if result.scan is not None:
                self._localizer.update(result.odometry.base_in_odom, result.scan)
            yield result

    def estimate(self, result: StepResult) -> Pose2:
        """Return the estimated pose of the base in the map."""
        odom_in_map = self._localizer.odom_in_map
        assert odom_in_map is not None, "no scan yet"
        return odom_in_map @ result.odometry.base_in_odom


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--hours", type=float, default=24.0, help="simulated time (default: 24)")
    parser.add_argument("--robot", choices=ROBOTS, default="turtlebot_lidar")
    parser.add_argument("--noise", choices=NOISE_PROFILES, default="turtlebot")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    return 0 if stands(options.robot, options.noise, options.seed, options.hours) else 1


def stands(name: str, noise: str, seed: int, hours: float) -> bool:
    """Print the largest deviations in the course of time; return whether they are small."""
    robot, start = LocalizedRobot(name, noise, seed), time.process_time()
    for _ in robot.run(TURN_SECONDS, Twist2(0.0, 0.5)):
        pass
    *_, first = robot.run(SETTLING_SECONDS)
    body, odometry, estimate = Deviation(), Deviation(), Deviation()
    print("hours stood  body                    odometry                estimate against truth")
    for line in range(LINES):
        for result in robot.run(hours * 3600.0 / LINES):
            body.add(result.base_in_world, first.base_in_world)
            odometry.add(result.odometry.base_in_odom, first.odometry.base_in_odom)
            estimate.add(robot.estimate(result), result.base_in_world)
        print(f"{hours * (line + 1) / LINES:11.2f} {body} {odometry} {estimate}", flush=True)
    are_small = body.is_small and odometry.is_small and estimate.is_small
    print(f"{'PASSED' if are_small else 'FAILED'} in {time.process_time() - start:.0f} s of CPU time")
    return are_small


if __name__ == "__main__":
    sys.exit(main())
