"""An evolution strategy (Salimans et al., 2017) for the network of plugin_examples.learned, on CPUs alone."""

import math
from multiprocessing import get_context
from typing import Iterator, List, Tuple

import numpy as np

from home_service_gym.environments import PointGoalEnv
from planar import Scan
from plugin_examples.learned import LOOKAHEAD, SECTORS, VIEW_RANGE, Policy, PolicyObservation

# Seeds of the homes that are trained in, control periods of an episode, spread and step of the weights.
HOMES = tuple(range(12))
MAX_PERIODS, SPREAD, STEP = 300, 0.05, 0.05
# Shares of what the robot could do that a planner lets it, 0.6 m/s and 1.8 rad/s of a TurtleBot.
LIMITS = np.array((0.6 / 0.7, 1.8 / math.pi))
_env: List[PointGoalEnv] = []


def sector_ranges(scan: Scan) -> np.ndarray:
    """How far it is in each sector to what the scan has met, (SECTORS,), m."""
    points = scan.hit_points_in_base()
    turns = np.arctan2(points[:, 1], points[:, 0]) / (2.0 * math.pi) + 0.5
    clear = np.full(SECTORS, VIEW_RANGE)
    np.minimum.at(clear, (turns * SECTORS).astype(int) % SECTORS, np.hypot(points[:, 0], points[:, 1]))
    return clear


def run_episode(env: PointGoalEnv, policy: Policy, seed: int) -> Tuple[float, str]:
    """An episode in one of the homes: its return, and how it ended."""
    observation, _ = env.reset(seed=seed, options={"seed": HOMES[seed % len(HOMES)]})
    total = 0.0
    for _ in range(MAX_PERIODS):
        x, y = observation["waypoint"].tolist()
        v, omega = (observation["velocity"] / (0.6, 1.8)).tolist()
        shares = policy.act(PolicyObservation(sector_ranges(env.state.scan), x, y, v, omega)) * LIMITS
        observation, reward, is_over, _, info = env.step(shares.astype(np.float32))
        total += reward
        if is_over:
            return total, info["outcome"]
    return total, "timeout"


def _run_episodes(task: Tuple[np.ndarray, Tuple[int, ...]]) -> Tuple[float, int]:
    """Mean return of some weights over episodes, and how many succeeded; in a process of a pool."""
    weights, seeds = task
    if not _env:
        _env.append(PointGoalEnv("homes", lookahead=LOOKAHEAD))
    results = [run_episode(_env[0], Policy(weights), seed) for seed in seeds]
    return float(np.mean([total for total, _ in results])), sum(how == "success" for _, how in results)


def evolve(
    generations: int, pairs: int, episodes: int, workers: int, seed: int
) -> Iterator[Tuple[int, float, float, np.ndarray]]:
    """After each generation its number, mean return, share of successes, and the weights then.

    Each generation tries ``pairs`` of opposite changes on the same ``episodes``.
    """
    rng = np.random.default_rng(seed)
    weights = np.zeros(Policy.WEIGHT_COUNT)
    weights[: -Policy.LAST_LAYER_SIZE] = rng.normal(0.0, 0.3, Policy.WEIGHT_COUNT - Policy.LAST_LAYER_SIZE)
    with get_context("spawn").Pool(workers) as pool:
        for generation in range(generations):
            seeds = tuple(rng.integers(2**31, size=episodes).tolist())
            changes = rng.normal(0.0, 1.0, (pairs, Policy.WEIGHT_COUNT))
            tried = np.concatenate((weights + SPREAD * changes, weights - SPREAD * changes))
            results = pool.map(_run_episodes, [(one, seeds) for one in tried], chunksize=1)
            returns = np.array([total for total, _ in results])
            ranks = np.argsort(np.argsort(returns)) / (len(returns) - 1.0) - 0.5
            weights = weights + STEP * (ranks[:pairs] - ranks[pairs:]) @ changes / pairs
            share = sum(count for _, count in results) / (len(results) * episodes)
            yield generation, float(returns.mean()), share, weights
