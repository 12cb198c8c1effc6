#!/usr/bin/env python3
"""Measures the Gymnasium environments: step rate compared with that of PyBullet alone, resets, processes.

The limit is the rate of the same physics steps in PyBullet alone: an episode is run, then repeated with only
its recorded motor commands. Both are measured in turn; the median of CPU time counts.

python3 tests/benchmarks/gymnasium_steps.py [--json FILE] [ENVIRONMENT ...]
"""

import argparse
import contextlib
import json
import multiprocessing
import statistics
import sys
import time
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any, Callable, Iterator, List, Tuple
from unittest.mock import patch

import gymnasium

import home_service_gym
from sim_bridge import Episode, Simulation
from sim_bridge.driving.drive import BASE_RATE
from sim_bridge.simulation import ROBOT_NAME

REPETITIONS, PERIODS, RESETS = 15, 100, 30
PAIRS, SECONDS = 5, 5.0
# Seed of the world, for environments with several.
WORLD = 2


@dataclass(frozen=True)
class Measurement:
    """Steps per second, reset times in a built world [ms]; ``share``: of the limit."""

    environment: str
    beams: int
    steps: float
    limit: float
    share: float
    reset_median: float
    reset_most: float


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("environments", nargs="*", metavar="ENVIRONMENT", default=home_service_gym.NAMES)
    parser.add_argument("--json", type=Path, metavar="FILE", help="writes the figures there too")
    options = parser.parse_args()
    print("environment          beams  steps/s  limit/s  share  reset ms, median and most")
    measured = []
    for name in options.environments:
        one = measure(name)
        measured.append(one)
        print(
            f"{one.environment:20} {one.beams:5} {one.steps:8.0f} {one.limit:8.0f} {one.share:6.2f} "
            f"{one.reset_median:9.1f} {one.reset_most:6.1f}",
            flush=True,
        )
    name = options.environments[0]
    two = {
        "each on its own": efficiency(independent_throughput, name),
        "in gymnasium's lock-step": efficiency(synchronised_throughput, name),
    }
    for how, (alone, both) in two.items():
        print(
            f"{name}, {how}: one process {alone:.0f}, two processes {both:.0f} steps/s, "
            f"efficiency {both / alone / 2.0:.2f} (median of {PAIRS} pairs)"
        )
    if options.json:
        results = {"environments": [asdict(one) for one in measured], "processes": two}
        options.json.write_text(json.dumps(results, indent=2) + "\n")
    return 0


def measure(name: str) -> Measurement:
    env = gymnasium.make(name).unwrapped
    world = {"seed": WORLD}
    env.reset(seed=0, options=world)
    env.action_space.seed(0)
    simulation = env._simulation._simulation  # type: ignore[attr-defined]
    step_seconds: List[float] = []
    physics_seconds: List[float] = []
    for seed in range(REPETITIONS + 1):
        actions = [env.action_space.sample() for _ in range(PERIODS)]
        env.reset(seed=seed, options=world)
        with recorded_motor_commands(simulation) as speeds:
            count = run_episode(env, actions)
        env.reset(seed=seed, options=world)
        step_seconds.append(cpu_seconds(partial(run_episode, env, actions)) / count)
        env.reset(seed=seed, options=world)
        physics_seconds.append(cpu_seconds(partial(replay, simulation, speeds)) / count)
    for _ in range(RESETS):  # fills the cache of paths
        env.reset(options=world)
    resets = [1e3 * cpu_seconds(lambda: env.reset(options=world)) for _ in range(RESETS)]
    scan = Episode(simulation, simulation.step_seconds).step().scan
    assert scan is not None
    env.close()
    step, bound = statistics.median(step_seconds[1:]), statistics.median(physics_seconds[1:])
    return Measurement(
        name, len(scan.ranges), 1 / step, 1 / bound, bound / step, statistics.median(resets), max(resets)
    )


def run_episode(env: gymnasium.Env, actions: List[Any]) -> int:
    """Step until the actions or the episode end; return the number of steps."""
    return next((count for count, action in enumerate(actions, start=1) if env.step(action)[2]), len(actions))


@contextlib.contextmanager
def recorded_motor_commands(simulation: Simulation) -> Iterator[List[Tuple[float, float, float]]]:
    """Record the motor commands."""
    vehicle = simulation.scene.robot(ROBOT_NAME).vehicle
    speeds: List[Tuple[float, float, float]] = []
    drive = vehicle.drive

    def record(left: float, right: float, seconds: float) -> None:
        speeds.append((left, right, seconds))
        drive(left, right, seconds)

    with patch.object(vehicle, "drive", record):
        yield speeds


def replay(simulation: Simulation, speeds: List[Tuple[float, float, float]]) -> None:
    """Repeat only the physics steps."""
    engine, vehicle = simulation.scene._engine, simulation.scene.robot(ROBOT_NAME).vehicle
    count = simulation.scene.settings.physics_rate // BASE_RATE
    for left, right, seconds in speeds:
        vehicle.drive(left, right, seconds)
        for _ in range(count):
            engine.step()


def cpu_seconds(do: Callable[[], object]) -> float:
    start = time.process_time()
    do()
    return time.process_time() - start


def efficiency(throughput: Callable[[str, int], float], name: str) -> Tuple[float, float]:
    """Steps per second of wall-clock time of one and of two processes: the median of several pairs."""
    pairs = [(throughput(name, 1), throughput(name, 2)) for _ in range(PAIRS)]
    return sorted(pairs, key=lambda pair: pair[1] / pair[0])[PAIRS // 2]


def independent_throughput(name: str, processes: int) -> float:
    """Total rate of environments that do not wait for each other."""
    forks = multiprocessing.get_context("fork")
    barrier, results = forks.Barrier(processes), forks.Queue()
    workers = [forks.Process(target=measure_steps, args=(name, barrier, results)) for _ in range(processes)]
    for worker in workers:
        worker.start()
    rate = sum(results.get(timeout=60.0) for _ in workers)
    for worker in workers:
        worker.join()
    return rate


def measure_steps(name: str, barrier: Any, results: Any) -> None:
    """Run steps for a fixed time; report the steps per second."""
    env = gymnasium.make(f"home_service_gym:{name}")
    env.reset(seed=0)
    env.action_space.seed(0)
    run_steps(env, PERIODS)
    barrier.wait()
    start, count = time.perf_counter(), 0
    while time.perf_counter() - start < SECONDS:
        count += run_steps(env, 10)
    results.put(count / (time.perf_counter() - start))


def run_steps(env: gymnasium.Env, periods: int) -> int:
    for _ in range(periods):
        _, _, is_over, is_late, _ = env.step(env.action_space.sample())
        if is_over or is_late:
            env.reset()
    return periods


def synchronised_throughput(name: str, processes: int) -> float:
    """Total rate of environments that wait for each other at every step."""
    envs = gymnasium.make_vec(f"home_service_gym:{name}", num_envs=processes, vectorization_mode="async")
    envs.reset(seed=0)
    envs.action_space.seed(0)
    for _ in range(PERIODS):
        envs.step(envs.action_space.sample())
    start, count = time.perf_counter(), 0
    while time.perf_counter() - start < SECONDS:
        envs.step(envs.action_space.sample())
        count += processes
    rate = count / (time.perf_counter() - start)
    envs.close()
    return rate


if __name__ == "__main__":
    sys.exit(main())
