#!/usr/bin/env python3
"""Drives BARN's worlds, as barn.py does, by any node that is a move_base.

python3 tests/benchmarks/barn_over_ros.py FOLDER
python3 tests/benchmarks/barn_over_ros.py FOLDER --node move_base/move_base --config jackal_dwa.yaml
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np
from barn import (
    ARRIVED,
    CONFIG,
    GOAL_IN_ODOM,
    SIMULATION,
    START,
    TIME_LIMIT,
    reference_length,
    score,
    worlds_in,
)
from helpers.robot_over_ros import RobotOverRos, add_node_options, client_with_goal, is_under_way, move_base

from sim_bridge import ROBOTS, Simulation, load_world


def main() -> int:
    options = _options()
    runs = []
    with move_base(options):
        robot = RobotOverRos(options.speed)
        for number, (world, path) in worlds_in(options.folder, options.only).items():
            for seed in range(options.seeds):
                simulation = Simulation(load_world(world), ROBOTS["jackal"], SIMULATION, seed, START)
                outcome, seconds = _drive(robot, simulation)
                points = score(seconds, reference_length(np.load(path))) if outcome == "success" else 0.0
                print(
                    f"world {number:3d} seed {seed}: {outcome:9s} {seconds:5.1f} s, score {points:.3f}",
                    flush=True,
                )
                runs.append((outcome, seconds, points))
    arrived = [seconds for outcome, seconds, _ in runs if outcome == "success"]
    summary = {
        "runs": len(runs),
        "score": round(float(np.mean([points for *_, points in runs])), 4),
        "success": round(len(arrived) / len(runs), 4),
        "mean_seconds": round(float(np.mean(arrived)), 2) if arrived else None,
    }
    print(json.dumps(summary, indent=2))
    return 0


def _drive(robot: RobotOverRos, simulation: Simulation):
    """Outcome and simulated seconds of one run; the clock starts with the goal."""
    robot.put(simulation)
    client = client_with_goal(robot, "odom", GOAL_IN_ODOM)
    began, goal, outcome = robot.now, START @ GOAL_IN_ODOM, "timeout"
    while robot.now - began < TIME_LIMIT:
        robot.step()
        if robot.observation.contacts:
            outcome = "collision"
            break
        if robot.observation.base_in_world.distance_to(goal) <= ARRIVED:
            outcome = "success"
            break
        if not is_under_way(client):
            outcome = "aborted"
            break
    client.cancel_all_goals()
    return outcome, robot.now - began


def _options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="with world_N.world and path_N.npy")
    parser.add_argument("--seeds", type=int, default=1, help="runs of each world, seeds 0, 1, ...")
    parser.add_argument("--only", type=int, nargs="+", help="numbers of the worlds to drive")
    add_node_options(parser, CONFIG)
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
