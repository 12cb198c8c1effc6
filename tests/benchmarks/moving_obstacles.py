#!/usr/bin/env python3
"""Drives scenarios with moving obstacles without ROS and reports whether contacts were avoidable.

    python3 tests/benchmarks/moving_obstacles.py scenarios/crossings.yaml --seeds 0-19
    python3 tests/benchmarks/moving_obstacles.py scenarios/crossings.yaml --families hard --seeds 100-109

With --gif FOLDER, the last seconds before each contact are drawn: true obstacles grey, tracked ones red, with
their velocities, the robot blue, and violet what it intended.
With --families the scenario's world is replaced by those of each family: easy, medium and hard are DynaBARN's
levels, the others the motions of laboratory.generators.motions.
A contact was avoidable if a search over the robot's controls, with the true motion of all obstacles, finds a
trajectory without a contact from a second before it until a second after it.
"""

import argparse
import json
import sys
from dataclasses import asdict, dataclass, replace
from multiprocessing import Pool
from pathlib import Path
from typing import List

import numpy as np
from helpers.drive_animation import FilmedNavigation, save_end
from helpers.timed_navigation import TimedNavigation

from headless_mission import EpisodeConditions
from laboratory.generators.crossings import POLYNOMIALS, STRAIGHT, CrossingCylinders
from laboratory.generators.motions import MOTIONS
from laboratory.results.avoidance import RobotLimits, TrueObstacles, can_avoid, state_before
from laboratory.scenario.seeds import parse_seeds
from laboratory.statistics.summary import share
from laboratory.suites import load_scenario
from laboratory.tasks.odom_goal import OdomGoalDrive, OdomGoalTask, navigation_config
from laboratory.tasks.task import COLLISION, SUCCESS
from laboratory.worlds.barn import score
from move_base_lite.warmup import warm_up
from planar import PlanarError, SettingsError
from sim_bridge import Simulation, robot_named

# Time before a contact from which it had to be avoided, and time after it without a contact [s].
BEFORE, AFTER = 1.0, 1.0
FAMILIES = {
    "easy": CrossingCylinders(0.5, 0.9, 5, 14, motion=POLYNOMIALS, orders=(1, 2)),
    "medium": CrossingCylinders(1.0, 1.4, 15, 18, motion=POLYNOMIALS, orders=(3, 5)),
    "hard": CrossingCylinders(1.5, 1.9, 20, 23, motion=POLYNOMIALS, orders=(4, 6)),
    **{motion: CrossingCylinders(motion=motion) for motion in (STRAIGHT, *MOTIONS) if motion != POLYNOMIALS},
}
# Speed below which the robot counts as standing [m/s].
STANDING_SPEED = 0.05


@dataclass(frozen=True)
class Run:
    """One run. Times in simulated seconds but ``tick_ms``, CPU time per control tick.

    ``scenario``: the scenario's file, or the family. ``avoidable``, ``speed`` and ``body``: of a contact,
    whether it was avoidable, the robot's speed and what it touched.
    """

    scenario: str
    seed: int
    outcome: str
    text: str
    seconds: float
    score: float
    tick_ms: List[float]
    avoidable: bool = False
    speed: float = 0.0
    body: str = ""


def main() -> int:
    options = _options()
    names = options.families or options.scenarios
    kinds = [(file, family) for file in options.scenarios for family in options.families or [None]]
    folder = options.gif
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    tasks = [(*kind, seed, folder) for kind in kinds for seed in parse_seeds(options.seeds)]
    runs: List[Run] = []
    with Pool(options.jobs) as pool:
        for run in pool.imap(_run, tasks):
            print(_line(run), flush=True)
            runs.append(run)
    for name in names:
        print(_summary(name, [run for run in runs if run.scenario == name]))
    print(_summary("all", runs))
    if options.json:
        Path(options.json).write_text(json.dumps([asdict(run) for run in runs]))
    return 0


def _run(task) -> Run:
    name, family, seed, folder = task
    scenario = load_scenario(name)
    if family is not None:
        name, scenario = family, replace(scenario, world=FAMILIES[family])
    if not isinstance(scenario.task, OdomGoalTask):
        raise SettingsError(f"{name}: its task must be reach")
    arena, robot, start = scenario.arena(seed), robot_named(scenario.robot), scenario.start
    settings = EpisodeConditions(scenario.planner, scenario.parameters).navigation(
        navigation_config(scenario.robot)
    )
    warm_up(settings)
    simulation = Simulation(arena.world, robot, scenario.simulation, seed, start)
    navigation = TimedNavigation(settings) if folder is None else FilmedNavigation(settings)
    drive = OdomGoalDrive(simulation, navigation, scenario.task, start)
    try:
        outcome, text = drive.run(scenario.seconds)
    finally:
        simulation.close()
    track = np.array(drive.observer.trajectory)
    seconds, body = float(track[-1, 0]), ", ".join(sorted(set(drive.observer.collisions)))
    length = arena.reference_length
    points = score(seconds, length) if length is not None and outcome == SUCCESS else 0.0
    run = Run(name, seed, outcome, text, seconds, points, navigation.tick_ms, body=body)
    if outcome != COLLISION:
        return run
    control = settings.controller
    half_length, half_width = np.abs(np.array(settings.local_costmap.footprint)).max(axis=0)
    limits = RobotLimits(
        *(control.min_vel_x, control.max_vel_x, control.max_vel_theta),
        *(control.acc_lim_x, control.acc_lim_theta),
        *(float(half_length), float(half_width)),
    )
    state, stamp = state_before(track, BEFORE)
    obstacles = TrueObstacles.of_world(arena.world)
    if isinstance(navigation, FilmedNavigation):
        outline = (float(half_length), float(half_width))
        save_end(folder / f"{Path(name).stem}_{seed}.gif", navigation.moments, obstacles, outline)
    is_avoidable = can_avoid(obstacles, limits, state, drive.start_stamp + stamp, BEFORE + AFTER)
    speed = state_before(track, 0.1)[0][3]
    return Run(**{**asdict(run), "avoidable": is_avoidable, "speed": speed})


def _line(run: Run) -> str:
    text = f"{Path(run.scenario).stem} {run.seed}: {run.outcome}, {run.seconds:.1f} s, score {run.score:.3f}"
    if run.outcome == COLLISION:
        fault = "avoidable" if run.avoidable else "unavoidable"
        fault += ", the robot stood" if abs(run.speed) < STANDING_SPEED else f", at {run.speed:.2f} m/s"
        return f"{text}; {fault}; {run.text}"
    return text if run.outcome == SUCCESS else f"{text}; {run.text}"


def _summary(name: str, runs: List[Run]) -> str:
    reached = [run for run in runs if run.outcome == SUCCESS]
    contacts = [run for run in runs if run.outcome == COLLISION]
    ticks = np.concatenate([run.tick_ms for run in runs])
    return (
        f"{Path(name).stem}: {len(runs)} runs, reached {share(len(reached), len(runs))}, "
        f"contacts {len(contacts)}, avoidable {sum(run.avoidable for run in contacts)}, "
        f"score {np.mean([run.score for run in runs]):.4f}, "
        f"{np.mean([run.seconds for run in reached]) if reached else np.nan:.2f} s, "
        f"tick {np.mean(ticks):.2f} ms, p99 {np.percentile(ticks, 99):.2f} ms"
    )


def _options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenarios", nargs="+", help="scenario files with the task reach")
    parser.add_argument("--families", nargs="+", choices=FAMILIES, help="worlds instead of the scenario's")
    parser.add_argument("--seeds", default="0-19", help="such as 0-19 or 1,5,7")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--gif", type=Path, metavar="FOLDER", help="folder for an animation of each contact")
    parser.add_argument("--json", help="file for the figures of every run")
    return parser.parse_args()


if __name__ == "__main__":
    try:
        sys.exit(main())
    except PlanarError as error:
        sys.exit(str(error))
