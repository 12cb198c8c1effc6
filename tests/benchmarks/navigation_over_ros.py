#!/usr/bin/env python3
"""Drives a simulated TurtleBot between random places of a home with any move_base node.

The node gets drifting odometry, scans and, as from a perfect localization, the true map -> odom. The official
move_base can be compared if it is installed:

    python3 tests/benchmarks/navigation_over_ros.py --pairs 20
    python3 tests/benchmarks/navigation_over_ros.py --pairs 20 --node move_base/move_base
"""

import argparse
import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import List, Set

import actionlib
import numpy as np
import psutil
from helpers.home_scenes import add_box, random_poses
from helpers.robot_over_ros import RobotOverRos, add_node_options, client_with_goal, is_active, move_base

from move_base_lite import load_settings
from planar import Pose2, load_map
from sim_bridge import Simulation, load_world

ROOT = Path(__file__).resolve().parents[2]
CONFIG = ROOT / "src" / "move_base_lite" / "config" / "turtlebot.yaml"


@dataclass(frozen=True)
class Run:
    """One drive: simulated seconds, metres, CPU seconds of the node."""

    status: str
    seconds: float
    driven: float
    off_by: float
    touched: List[str]
    cpu_seconds: float


def main() -> int:
    options = _options()
    settings, grid, world = load_settings(CONFIG), load_map(options.map), load_world(options.world)
    with move_base(options) as node:
        robot, runs = RobotOverRos(options.speed, grid), []
        for pair in range(options.pairs):
            rng = np.random.default_rng([options.seed, pair])
            start, goal = random_poses(settings, grid, rng, 2)
            simulation = Simulation(world, seed=pair, base_in_world=start)
            for number in range(options.boxes):
                add_box(simulation, f"box_{number}", settings, grid, rng, keep_free=(start, goal))
            robot.switch_simulation(simulation)
            runs.append(_drive_to(robot, goal, psutil.Process(node.pid), options.limit))
            print(pair, runs[-1], flush=True)
        print(json.dumps(_summary(runs), indent=2))
    return 0


def _drive_to(robot: RobotOverRos, goal: Pose2, process: psutil.Process, limit: float) -> Run:
    client = client_with_goal(robot, "map", goal)
    cpu, start = sum(process.cpu_times()[:2]), robot.now
    last, driven = robot.observation.base_in_world, 0.0
    touched: Set[str] = set()
    while robot.now - start < limit and is_active(client):
        robot.step()
        touched.update(robot.observation.contacts)
        driven += last.distance_to(robot.observation.base_in_world)
        last = robot.observation.base_in_world
    state = client.get_state()
    if is_active(client):
        client.cancel_all_goals()
    return Run(
        actionlib.GoalStatus.to_string(state),
        robot.now - start,
        driven,
        last.distance_to(goal),
        sorted(touched),
        sum(process.cpu_times()[:2]) - cpu,
    )


def _summary(runs: List[Run]) -> dict:
    reached = [run for run in runs if run.status == "SUCCEEDED"]
    return {
        "runs": len(runs),
        "reached": len(reached),
        "runs_with_collision": sum(bool(run.touched) for run in runs),
        "mean_seconds": round(float(np.mean([run.seconds for run in reached])), 2),
        "mean_driven": round(float(np.mean([run.driven for run in reached])), 2),
        "cpu_share": round(sum(run.cpu_seconds for run in runs) / sum(run.seconds for run in runs), 3),
    }


def _options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_node_options(parser, CONFIG)
    parser.add_argument("--pairs", type=int, default=20, help="number of random pairs of start and goal")
    parser.add_argument("--boxes", type=int, default=0, help="boxes that the map does not show")
    parser.add_argument("--seed", type=int, default=0, help="seed of all random numbers")
    parser.add_argument("--limit", type=float, default=120.0, help="simulated seconds a drive may take")
    parser.add_argument("--world", default=ROOT / "map" / "home.world", help="SDF file of the world")
    parser.add_argument("--map", default=ROOT / "map" / "home.yaml", help="map_server file of its map")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
