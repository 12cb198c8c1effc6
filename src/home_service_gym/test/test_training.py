"""The evolution strategy is deterministic and changes the weights."""

import numpy as np
import pytest

from home_service_gym import training
from home_service_gym.environments import PointGoalEnv
from home_service_gym.training import evolve, run_episode, sector_ranges
from planar import Scan
from plugin_examples.learned import LOOKAHEAD, SECTORS, VIEW_RANGE, Policy


def test_sectors_hold_the_distance_to_the_nearest_scan_point():
    ranges = np.full(360, np.inf)
    ranges[180] = 0.7  # straight ahead
    clear = sector_ranges(Scan(0.0, -np.pi, 2.0 * np.pi / 360, ranges, 0.1, 8.0))
    assert clear[SECTORS // 2] == pytest.approx(0.7)
    assert np.delete(clear, SECTORS // 2) == pytest.approx(VIEW_RANGE)


def test_zero_weights_follow_the_path_to_some_goals(monkeypatch):
    monkeypatch.setattr(training, "HOME_SEEDS", (0,))
    env = PointGoalEnv("home_errand", lookahead=LOOKAHEAD)
    outcomes = [run_episode(env, Policy(np.zeros(Policy.WEIGHT_COUNT)), seed)[1] for seed in range(6)]
    env.close()
    assert outcomes.count("success") >= 2, outcomes


def test_training_depends_on_the_seed():
    runs = [list(evolve(generations=2, pairs=1, episodes=1, workers=1, seed=3)) for _ in range(2)]
    weights = [[generation[-1] for generation in run] for run in runs]
    assert [generation[0] for generation in runs[0]] == [0, 1]
    assert np.array_equal(weights[0], weights[1])
    assert not np.array_equal(weights[0][0], weights[0][1])
