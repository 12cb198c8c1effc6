"""Evolution strategy (Salimans et al., 2017) for the network of plugin_examples.learned, on the CPU."""

import math
from multiprocessing import get_context
from typing import Iterator, List, Tuple

import numpy as np

from home_service_gym.environments import PointGoalEnv
from planar import Scan
from plugin_examples.learned import LOOKAHEAD, SECTORS, VIEW_RANGE, Policy, PolicyObservation

# Seeds of the training homes; control periods of an episode, standard deviation and step size of the weights.
HOME_SEEDS = tuple(range(12))
MAX_PERIODS, SPREAD, STEP = 300, 0.05, 0.05
# Limits of the planner (0.6 m/s, 1.8 rad/s) as shares of those of the TurtleBot.
LIMITS = np.array((0.6 / 0.7, 1.8 / math.pi))
_env: List[PointGoalEnv] = []


def sector_ranges(scan: Scan) -> np.ndarray:
    """Return the distance to the nearest scan point in each sector, (SECTORS,) [m]."""
    points = scan.hit_points_in_base()
    turns = np.arctan2(points[:, 1], points[:, 0]) / (2.0 * math.pi) + 0.5
    clear = np.full(SECTORS, VIEW_RANGE)
    np.minimum.at(clear, (turns * SECTORS).astype(int) % SECTORS, np.hypot(points[:, 0], points[:, 1]))
    return clear


def run_episode(env: PointGoalEnv, policy: Policy, seed: int) -> Tuple[float, str]:
    """Run an episode in one of the homes; return the sum of rewards and the outcome."""
    observation, _ = env.reset(seed=seed, options={"seed": HOME_SEEDS[seed % len(HOME_SEEDS)]})
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
    """Mean return of weights over episodes, and the number of successes; runs in a pool process."""
    weights, seeds = task
    if not _env:
        _env.append(PointGoalEnv("homes", lookahead=LOOKAHEAD))
    results = [run_episode(_env[0], Policy(weights), seed) for seed in seeds]
    return float(np.mean([total for total, _ in results])), sum(how == "success" for _, how in results)


def evolve(
    generations: int, pairs: int, episodes: int, workers: int, seed: int
) -> Iterator[Tuple[int, float, float, np.ndarray]]:
    """Train the weights.

    Args:
        generations: Number of generations.
        pairs: Antithetic pairs of weight changes in each generation.
        episodes: Episodes for each candidate, the same in a generation.
        workers: Number of processes.
        seed: Seed of all random numbers.

    Yields:
        Number of the generation, mean return, share of successes and weights after it.
    """
    rng = np.random.default_rng(seed)
    weights = np.zeros(Policy.WEIGHT_COUNT)
    weights[: -Policy.LAST_LAYER_SIZE] = rng.normal(0.0, 0.3, Policy.WEIGHT_COUNT - Policy.LAST_LAYER_SIZE)
    with get_context("spawn").Pool(workers) as pool:
        for generation in range(generations):
            seeds = tuple(rng.integers(2**31, size=episodes).tolist())
            changes = rng.normal(0.0, 1.0, (pairs, Policy.WEIGHT_COUNT))
            candidates = np.concatenate((weights + SPREAD * changes, weights - SPREAD * changes))
            results = pool.map(_run_episodes, [(one, seeds) for one in candidates], chunksize=1)
            returns = np.array([total for total, _ in results])
            ranks = np.argsort(np.argsort(returns)) / (len(returns) - 1.0) - 0.5
            weights = weights + STEP * (ranks[:pairs] - ranks[pairs:]) @ changes / pairs
            share = sum(count for _, count in results) / (len(results) * episodes)
            yield generation, float(returns.mean()), share, weights
