#!/usr/bin/env python3
"""Measure how fast idle time passes in one process: a robot in its dock in the home, without ROS.

python3 tests/benchmarks/idle_time.py [--hours 5] [--stepped 20]

In turn, an idle hour is skipped and some seconds are stepped, with all sensors of the robot; printed are the
multiples of real time by CPU time, their medians and the ratio. Exit code 1 if an idle hour passes less than
1,000 times as fast as real time.
"""

import argparse
import statistics
import sys
import time
from typing import Dict, List

from auto_docking_lite.poses import pose_when_docked
from evaluation.options import HOME_WORLD
from planar import Pose2
from sim_bridge import Episode, Simulation, load_world
from sim_bridge.docks import with_dock

DOCK, HOUR = Pose2(-1.5, -3.2, 1.57), 3600.0
LEAST = 1000.0


def main():
    """Measure."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--hours", type=int, default=5)
    parser.add_argument("--stepped", type=float, default=20.0, metavar="SECONDS")
    options = parser.parse_args()
    world, start = with_dock(load_world(HOME_WORLD), DOCK), pose_when_docked(DOCK) @ Pose2(-0.01)
    simulation = Simulation(world, base_in_world=start)
    episode, scene = Episode(simulation, 0.1), simulation.scene
    while not episode.idle(scene.stamp + 1.0):
        episode.advance()
    factors: Dict[str, List[float]] = {"skipped": [], "stepped": []}
    for _ in range(options.hours):
        begin = time.process_time()
        assert episode.idle(scene.stamp + HOUR), "the robot moves"
        factors["skipped"].append(HOUR / (time.process_time() - begin))
        begin = time.process_time()
        for _ in range(round(options.stepped / 0.1)):
            episode.advance()
        factors["stepped"].append(options.stepped / (time.process_time() - begin))
    skipped, stepped = (statistics.median(values) for values in factors.values())
    print(
        f"skipped {skipped:.0f} x real time, stepped {stepped:.0f} x: {skipped / stepped:.0f} times as fast"
    )
    return int(skipped < LEAST)


if __name__ == "__main__":
    sys.exit(main())
