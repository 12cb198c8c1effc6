#!/usr/bin/env python3
"""Drive a scenario's robot to its goal without a map, as evaluate.sh does, by move_base or a compatible node.

SCENARIO is a file or a name in scenarios/ whose task is to reach a place: barn, dynabarn, fields, crossings.
The official move_base, where it is installed, is compared on the same seeds:

    python3 tests/benchmarks/reach_over_ros.py dynabarn --seeds 0-23
    python3 tests/benchmarks/reach_over_ros.py dynabarn --seeds 0-23 --node move_base/move_base \\
        --local-planner dwa_local_planner/DWAPlannerROS
"""

import argparse
import json
import sys

import numpy as np
from helpers.robot_over_ros import RobotOverRos, add_node_options, client_with_goal, is_active, move_base

from laboratory.scenario.seeds import parse_seeds
from laboratory.statistics.summary import share
from laboratory.suites import load_scenario
from laboratory.tasks.odom_goal import navigation_config
from laboratory.worlds.barn import score
from sim_bridge import Simulation, robot_named


def main() -> int:
    options = _options()
    scenario = load_scenario(options.scenario)
    seeds = scenario.seeds if options.seeds is None else parse_seeds(options.seeds)
    profile, runs = robot_named(scenario.robot), []
    options.config = options.config or navigation_config(scenario.robot)
    with move_base(options, scenario.parameters):
        robot = RobotOverRos(options.speed)
        for seed in seeds:
            arena = scenario.arena(seed)
            simulation = Simulation(arena.world, profile, scenario.simulation, seed, scenario.start)
            outcome, seconds = _drive(robot, simulation, scenario)
            points = (
                score(seconds, arena.reference_length)
                if outcome == "success" and arena.reference_length
                else 0.0
            )
            print(f"seed {seed}: {outcome:9s} {seconds:5.1f} s, score {points:.3f}", flush=True)
            runs.append((outcome, seconds, points))
    print(json.dumps(_summary(runs), indent=2))
    return 0


def _drive(robot: RobotOverRos, simulation: Simulation, scenario):
    """Return outcome and duration [simulated s] of a run; time counts from the goal on."""
    robot.switch_simulation(simulation)
    client = client_with_goal(robot, "odom", scenario.task.goal)
    start, goal, outcome = robot.now, scenario.start @ scenario.task.goal, "timeout"
    while robot.now - start < scenario.seconds:
        robot.step()
        if robot.observation.contacts:
            outcome = "collision"
            break
        if robot.observation.base_in_world.distance_to(goal) <= scenario.task.radius:
            outcome = "success"
            break
        if not is_active(client):
            outcome = "aborted"
            break
    client.cancel_all_goals()
    return outcome, robot.now - start


def _summary(runs) -> dict:
    outcomes, seconds, points = zip(*runs)
    arrived = [each for outcome, each in zip(outcomes, seconds) if outcome == "success"]
    return {
        "runs": len(runs),
        "score": round(float(np.mean(points)), 4),
        "outcomes": {outcome: outcomes.count(outcome) for outcome in sorted(set(outcomes))},
        "success": str(share(len(arrived), len(runs))),
        "mean_seconds": round(float(np.mean(arrived)), 2) if arrived else None,
    }


def _options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario", help="file of a scenario, or its name in scenarios/")
    parser.add_argument("--seeds", help="like 0-23 (default: those of the scenario)")
    add_node_options(parser, None)
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
