#!/usr/bin/env python3
"""Drives BARN's worlds (Perille et al., "Benchmarking metric ground navigation", 2020) without ROS.

No map: a Jackal plans in odom to a place ten metres ahead. A run ends within 1 m of it, at the first touch,
or after 100 simulated seconds. Score of a run: OT / clip(time, 2 OT, 8 OT), OT the time that the benchmark's
reference path takes at 2 m/s; 0 unless it has arrived. The best possible score is 0.5.

    python3 tests/benchmarks/barn.py FOLDER --seeds 10

FOLDER holds, at any depth, files world_N.world and path_N.npy of the BARN data set.
"""

import argparse
import json
import sys
from dataclasses import asdict, dataclass
from multiprocessing import Pool
from pathlib import Path
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np
from helpers.timed_navigation import TimedNavigation

from laboratory.tasks.odom_goal import OdomGoalDrive, OdomGoalTask
from laboratory.tasks.task import SUCCESS
from laboratory.worlds.barn import GOAL_IN_ODOM, START, BarnFolder, reference_length, score
from move_base_lite import load_settings
from move_base_lite.warmup import warm_up
from planar import SettingsError
from sim_bridge import ROBOTS, Simulation, SimulationSettings, load_world

CONFIG = Path(__file__).resolve().parents[2] / "src" / "move_base_lite" / "config" / "jackal.yaml"
ARRIVED = 1.0
TIME_LIMIT = 100.0
SIMULATION = SimulationSettings(odometry_rate=100, scan_rate=20)


@dataclass(frozen=True)
class Run:
    """One run. Lengths in metres, times in simulated seconds but ``tick_ms_*``, CPU time per control tick."""

    world: int
    seed: int
    outcome: str
    text: str
    seconds: float
    driven: float
    score: float
    recoveries: int
    tick_ms_mean: float
    tick_ms_p99: float


def main() -> int:
    options = _options()
    worlds = worlds_in(options.folder, options.only)
    settings = load_settings(options.config)
    warm_up(settings)
    tasks = [
        (number, *files, seed, settings) for number, files in worlds.items() for seed in range(options.seeds)
    ]
    runs: List[Run] = []
    with Pool(options.jobs) as pool:
        for run in pool.imap(_run, tasks):
            print(
                f"world {run.world:3d} seed {run.seed}: {run.outcome:9s} {run.seconds:5.1f} s, "
                f"{run.driven:5.2f} m, score {run.score:.3f}, {run.recoveries} recoveries, "
                f"{run.tick_ms_mean:.1f} ms a tick {run.text}",
                flush=True,
            )
            runs.append(run)
    summary = _summary(runs)
    print(json.dumps(summary, indent=2))
    if options.json:
        details = {"summary": summary, "runs": [asdict(run) for run in runs]}
        Path(options.json).write_text(json.dumps(details, indent=2))
    return 0


def _run(task) -> Run:
    number, world_file, path_file, seed, settings = task
    simulation = Simulation(load_world(world_file), ROBOTS["jackal"], SIMULATION, seed, START)
    navigation = TimedNavigation(settings)
    drive = OdomGoalDrive(simulation, navigation, OdomGoalTask(GOAL_IN_ODOM, ARRIVED), START)
    try:
        outcome, text = drive.run(TIME_LIMIT)
    finally:
        simulation.close()
    track = np.array(drive.observer.trajectory)
    seconds = float(track[-1, 0])
    return Run(
        world=number,
        seed=seed,
        outcome=outcome,
        text="" if outcome == SUCCESS else text,
        seconds=seconds,
        driven=float(np.hypot(*np.diff(track[:, 1:3], axis=0).T).sum()),
        score=score(seconds, reference_length(np.load(path_file))) if outcome == SUCCESS else 0.0,
        recoveries=navigation.recoveries,
        tick_ms_mean=float(np.mean(navigation.tick_ms)),
        tick_ms_p99=float(np.percentile(navigation.tick_ms, 99)),
    )


def worlds_in(folder: Path, only: Optional[Sequence[int]]) -> Dict[int, Tuple[Path, Path]]:
    """Number -> files of the world and of its reference path, of all worlds or some."""
    try:
        both = {number: (world, path) for number, world, path in BarnFolder(folder).pairs()}
    except SettingsError as error:
        sys.exit(str(error))
    return {number: both[number] for number in (both if only is None else only)}


def _summary(runs: List[Run]) -> dict:
    outcomes = [run.outcome for run in runs]
    arrived = [run for run in runs if run.outcome == "success"]
    return {
        "runs": len(runs),
        "score": round(float(np.mean([run.score for run in runs])), 4),
        "success": round(len(arrived) / len(runs), 4),
        "outcomes": {outcome: outcomes.count(outcome) for outcome in sorted(set(outcomes))},
        "mean_seconds": round(float(np.mean([run.seconds for run in arrived])), 2) if arrived else None,
        "mean_driven": round(float(np.mean([run.driven for run in arrived])), 2) if arrived else None,
        "recoveries": sum(run.recoveries for run in runs),
        "tick_ms_mean": round(float(np.mean([run.tick_ms_mean for run in runs])), 2),
        "tick_ms_p99": round(float(np.max([run.tick_ms_p99 for run in runs])), 2),
    }


def _options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="with world_N.world and path_N.npy")
    parser.add_argument("--seeds", type=int, default=10, help="runs of each world, seeds 0, 1, ...")
    parser.add_argument("--only", type=int, nargs="+", help="numbers of the worlds to drive")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--config", default=CONFIG, help="parameters")
    parser.add_argument("--json", help="file for the figures of every run")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
