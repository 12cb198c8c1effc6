#!/usr/bin/env python3
"""Drives a simulated TurtleBot between random places of a home, without ROS, and measures the result.

It localizes itself from scans and drifting odometry; the truth is for the starting pose and the referee.

    python3 tests/benchmarks/navigation.py --pairs 50 --boxes 6 --walkers 4
"""

import argparse
import json
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import List, Optional, Set

import numpy as np
from helpers.home_scenes import add_box, random_poses
from helpers.timed_navigation import TimedNavigation
from helpers.walkers import MIN_MOVING_SPEED, Walker, add_walkers

from headless_mission.localization import LocalizationHooks
from move_base_lite import NavigatorSettings, Status, load_settings
from move_base_lite.warmup import warm_up
from planar import OccupancyGrid, Pose2, load_map, wrap
from sim_bridge import ROBOTS, Episode, EpisodeHooks, Simulation, StepResult, load_world
from sim_bridge.world import World

ROOT = Path(__file__).resolve().parents[2]
# Simulation steps between two updates of the pedestrians.
WALKER_PERIOD_STEPS = 2


@dataclass(frozen=True)
class Run:
    """One drive. Lengths in metres, times in simulated seconds but ``tick_ms``, CPU time per control tick.

    ``touched``: what the robot has touched; ``bumped_into``: the people that touched it while it stood.
    """

    pair: int
    status: str
    text: str
    seconds: float
    planned: float
    driven: float
    off_by: float
    off_by_angle: float
    recoveries: int
    touched: List[str]
    bumped_into: List[str]
    tick_ms: List[float]


def main() -> int:
    options = _options()
    settings, grid = load_settings(options.config, *options.custom), load_map(options.map)
    world = load_world(options.world)
    warm_up(settings)
    pairs = range(options.pairs) if options.only is None else [options.only]
    runs = [_drive(pair, options, settings, grid, world) for pair in pairs]
    summary = _summary(runs)
    print(json.dumps(summary, indent=2))
    if options.json:
        details = [{**asdict(run), "tick_ms": None} for run in runs]
        Path(options.json).write_text(json.dumps({"summary": summary, "runs": details}, indent=2))
    return 0 if summary["reached"] == len(runs) and not summary["runs_with_collision"] else 1


def _drive(pair: int, options, settings: NavigatorSettings, grid: OccupancyGrid, world: World) -> Run:
    rng = np.random.default_rng([options.seed, pair])
    start, goal = random_poses(settings, grid, rng, 2)
    simulation = Simulation(world, ROBOTS[options.robot], seed=pair, base_in_world=start)
    for number in range(options.boxes):
        add_box(simulation, f"box_{number}", settings, grid, rng, keep_free=(start, goal))
    ends = random_poses(settings, grid, rng, 2 * options.walkers)
    walkers = add_walkers(simulation, options.walkers, settings, grid, ends, start, rng, options.heedless)
    try:
        run = _drive_to(pair, options, simulation, TimedNavigation(settings, grid), start, goal, walkers)
    finally:
        simulation.close()
    touched = f", touched {', '.join(run.touched)}" if run.touched else ""
    print(
        f"{pair:4d} {run.status:9s} {run.seconds:5.1f} s, {run.driven:5.2f} m of {run.planned:5.2f} planned, "
        f"{run.recoveries} recoveries{touched} {run.text if run.status != 'succeeded' else ''}",
        flush=True,
    )
    return run


def _drive_to(
    pair: int,
    options,
    simulation: Simulation,
    navigation: TimedNavigation,
    start: Pose2,
    goal: Pose2,
    walkers: List[Walker],
) -> Run:
    localization = LocalizationHooks(load_map(options.map), options.seed, start, navigation.poses)
    observer = WalkerHooks(walkers, start)
    hooks = observer, navigation, localization
    episode = Episode(simulation, 1.0 / options.rate, hooks=hooks)
    navigation.move_base.set_goal(goal)
    start_stamp = episode.step().stamp
    while not navigation.result.decision.status.is_final:
        step = episode.advance()
        if step.stamp - start_stamp >= options.limit:
            break
    decision, last = navigation.result.decision, step.base_in_world
    return Run(
        pair=pair,
        status=decision.status.value,
        text=decision.text,
        seconds=step.stamp - start_stamp,
        planned=navigation.planned,
        driven=observer.driven,
        off_by=last.distance_to(goal),
        off_by_angle=abs(wrap(last.yaw - goal.yaw)),
        recoveries=navigation.recoveries,
        touched=sorted(observer.touched),
        bumped_into=sorted(observer.bumped_into),
        tick_ms=navigation.tick_ms,
    )


class WalkerHooks(EpisodeHooks):
    """Moves pedestrians, and records distance and contacts of the robot.

    Attributes:
        driven: Distance that the robot has driven [m].
        touched: What the robot has touched.
        bumped_into: Pedestrians that touched it while it stood.
    """

    def __init__(self, walkers: List[Walker], start: Pose2):
        self._walkers, self._truth, self._last = walkers, start, start
        self._people = {f"{walker.name}::link" for walker in walkers}
        self._steps, self.driven = 0, 0.0
        self.touched: Set[str] = set()
        self.bumped_into: Set[str] = set()

    def before_step(self, episode: Episode) -> None:
        for walker in self._walkers if self._steps % WALKER_PERIOD_STEPS == 0 else ():
            walker.walk(self._truth, WALKER_PERIOD_STEPS * episode.simulation.step_seconds)
        self._steps += 1

    def after_step(self, episode: Episode, step: StepResult) -> None:
        self._truth = step.base_in_world
        for name in step.contacts:
            stands = name in self._people and abs(step.odometry.twist.v) < MIN_MOVING_SPEED
            (self.bumped_into if stands else self.touched).add(name)

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        self.driven += self._last.distance_to(step.base_in_world)
        self._last = step.base_in_world


def _summary(runs: List[Run]) -> dict:
    reached = [run for run in runs if run.status == Status.SUCCEEDED.value]
    ticks = np.concatenate([run.tick_ms for run in runs])
    return {
        "runs": len(runs),
        "reached": len(reached),
        "runs_with_collision": sum(bool(run.touched) for run in runs),
        "runs_bumped_into": sum(bool(run.bumped_into) for run in runs),
        "recoveries": sum(run.recoveries for run in runs),
        "mean_seconds": _mean([run.seconds for run in reached]),
        "mean_speed": _mean([run.driven / run.seconds for run in reached]),
        "driven_over_planned": _mean([run.driven / run.planned for run in reached if run.planned > 1.0]),
        "worst_off_by": max((run.off_by for run in reached), default=None),
        "worst_off_by_angle": max((run.off_by_angle for run in reached), default=None),
        "tick_ms_mean": round(float(ticks.mean()), 3),
        "tick_ms_p99": round(float(np.percentile(ticks, 99)), 3),
        "tick_ms_max": round(float(ticks.max()), 3),
    }


def _mean(values: List[float]) -> Optional[float]:
    return round(float(np.mean(values)), 3) if values else None


def _options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=50, help="number of random pairs of start and goal")
    parser.add_argument("--only", type=int, help="drive only the pair of this number")
    parser.add_argument("--boxes", type=int, default=0, help="boxes that the map does not show")
    parser.add_argument("--walkers", type=int, default=0, help="people that walk to and fro")
    parser.add_argument("--heedless", action="store_true", help="they do not wait for the robot")
    parser.add_argument("--robot", default="turtlebot_lidar", choices=ROBOTS, help="which robot drives")
    parser.add_argument("--seed", type=int, default=0, help="of all chance")
    parser.add_argument("--limit", type=float, default=180.0, help="simulated seconds a drive may take")
    parser.add_argument("--rate", type=float, default=10.0, help="control ticks per simulated second")
    parser.add_argument("--world", default=ROOT / "map" / "home.world", help="SDF file of the world")
    parser.add_argument("--map", default=ROOT / "map" / "home.yaml", help="map_server file of its map")
    parser.add_argument(
        "--config", default=ROOT / "src" / "move_base_lite" / "config" / "turtlebot.yaml", help="parameters"
    )
    parser.add_argument("--custom", nargs="*", default=[], help="files of parameters that override those")
    parser.add_argument("--json", help="file for the figures of every run")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
