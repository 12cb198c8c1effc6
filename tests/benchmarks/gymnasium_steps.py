#!/usr/bin/env python3
"""Measures the Gymnasium environments: steps a second beside PyBullet's own limit, resets, processes.

The limit is what PyBullet alone takes for the same steps of physics: an episode is played, then begun again
with nothing but what its motors were set to. Each is measured in turns; the median of CPU time counts.

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
from sim_bridge import Simulation
from sim_bridge.driving.drive import BASE_RATE
from sim_bridge.simulation import ROBOT_NAME

BLOCKS, PERIODS, RESETS = 15, 100, 30
PAIRS, SECONDS = 5, 5.0
# The world that is measured, of environments that have many.
WORLD = 2


@dataclass(frozen=True)
class Measurement:
    """Steps a second, resets in ms in a world that is built; ``share``: of the limit."""

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
    two = {"each on its own": efficiency(apart, name), "in gymnasium's lock-step": efficiency(in_step, name)}
    for how, (alone, both) in two.items():
        print(
            f"{name}, {how}: one process {alone:.0f}, two processes {both:.0f} steps/s, "
            f"efficiency {both / alone / 2.0:.2f} (median of {PAIRS} pairs)"
        )
    if options.json:
        told = {"environments": [asdict(one) for one in measured], "processes": two}
        options.json.write_text(json.dumps(told, indent=2) + "\n")
    return 0


def measure(name: str) -> Measurement:
    env = gymnasium.make(name).unwrapped
    world = {"seed": WORLD}
    env.reset(seed=0, options=world)
    env.action_space.seed(0)
    simulation = env._simulation._simulation  # type: ignore[attr-defined]
    taken: List[float] = []
    least: List[float] = []
    for seed in range(BLOCKS + 1):
        actions = [env.action_space.sample() for _ in range(PERIODS)]
        env.reset(seed=seed, options=world)
        with motors_of(simulation) as speeds:
            count = play(env, actions)
        env.reset(seed=seed, options=world)
        taken.append(cpu_seconds(partial(play, env, actions)) / count)
        env.reset(seed=seed, options=world)
        least.append(cpu_seconds(partial(replay, simulation, speeds)) / count)
    for _ in range(RESETS):  # the ways of a home are looked for once
        env.reset(options=world)
    resets = [1e3 * cpu_seconds(lambda: env.reset(options=world)) for _ in range(RESETS)]
    scan = simulation.step().scan
    env.close()
    step, bound = statistics.median(taken[1:]), statistics.median(least[1:])
    return Measurement(
        name, len(scan.ranges), 1 / step, 1 / bound, bound / step, statistics.median(resets), max(resets)
    )


def play(env: gymnasium.Env, actions: List[Any]) -> int:
    """Steps until the actions or the episode are over; how many those were."""
    return next((count for count, action in enumerate(actions, start=1) if env.step(action)[2]), len(actions))


@contextlib.contextmanager
def motors_of(simulation: Simulation) -> Iterator[List[Tuple[float, float]]]:
    """Keeps what the motors are set to each time."""
    vehicle = simulation.scene.robot(ROBOT_NAME).vehicle
    speeds: List[Tuple[float, float]] = []
    drive = vehicle.drive

    def kept(left: float, right: float) -> None:
        speeds.append((left, right))
        drive(left, right)

    with patch.object(vehicle, "drive", kept):
        yield speeds


def replay(simulation: Simulation, speeds: List[Tuple[float, float]]) -> None:
    """The same steps of physics, one by one, without all else."""
    engine, vehicle = simulation.scene._engine, simulation.scene.robot(ROBOT_NAME).vehicle
    count = simulation.scene.settings.physics_rate // BASE_RATE
    for left, right in speeds:
        vehicle.drive(left, right)
        for _ in range(count):
            engine.step()


def cpu_seconds(do: Callable[[], object]) -> float:
    began = time.process_time()
    do()
    return time.process_time() - began


def efficiency(throughput: Callable[[str, int], float], name: str) -> Tuple[float, float]:
    """Steps a second, by the clock, of one process and of two: the middle one of some pairs in turn."""
    pairs = [(throughput(name, 1), throughput(name, 2)) for _ in range(PAIRS)]
    return sorted(pairs, key=lambda pair: pair[1] / pair[0])[PAIRS // 2]


def apart(name: str, processes: int) -> float:
    """Of environments that do not wait for each other, as for learning from whole episodes."""
    forks = multiprocessing.get_context("fork")
    barrier, told = forks.Barrier(processes), forks.Queue()
    workers = [forks.Process(target=work, args=(name, barrier, told)) for _ in range(processes)]
    for worker in workers:
        worker.start()
    rate = sum(told.get(timeout=60.0) for _ in workers)
    for worker in workers:
        worker.join()
    return rate


def work(name: str, barrier: Any, told: Any) -> None:
    """Plays until the time is over, and tells the steps a second."""
    env = gymnasium.make(f"home_service_gym:{name}")
    env.reset(seed=0)
    env.action_space.seed(0)
    play_on(env, PERIODS)
    barrier.wait()
    began, count = time.perf_counter(), 0
    while time.perf_counter() - began < SECONDS:
        count += play_on(env, 10)
    told.put(count / (time.perf_counter() - began))


def play_on(env: gymnasium.Env, periods: int) -> int:
    for _ in range(periods):
        _, _, is_over, is_late, _ = env.step(env.action_space.sample())
        if is_over or is_late:
            env.reset()
    return periods


def in_step(name: str, processes: int) -> float:
    """Of environments each of which waits for the others at every step."""
    envs = gymnasium.make_vec(f"home_service_gym:{name}", num_envs=processes, vectorization_mode="async")
    envs.reset(seed=0)
    envs.action_space.seed(0)
    for _ in range(PERIODS):
        envs.step(envs.action_space.sample())
    began, count = time.perf_counter(), 0
    while time.perf_counter() - began < SECONDS:
        envs.step(envs.action_space.sample())
        count += processes
    rate = count / (time.perf_counter() - began)
    envs.close()
    return rate


if __name__ == "__main__":
    sys.exit(main())
