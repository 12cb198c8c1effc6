"""The built-in models pass the contract checks; faulty models fail them."""

import sys
from itertools import product

import numpy as np
import pytest

from amcl_lite import LocalizerSettings
from amcl_lite.check import CHECK_SUITES, MOTION_CHECKS, SENSOR_CHECKS
from amcl_lite.config import MOTION_MODELS, SENSOR_MODELS
from planar.extensions.check import run_checks


class Indifferent:
    def __init__(self, grid, settings):
        pass

    def log_likelihoods(self, poses, beams):
        return np.zeros(len(poses))


class NotOutside(Indifferent):
    def log_likelihoods(self, poses, beams):
        return np.where(np.abs(poses[:, 0]) < 10.0, 0.0, np.nan)


class ByChance(Indifferent):
    def log_likelihoods(self, poses, beams):
        return np.random.default_rng().random(len(poses))


class Scribbles(Indifferent):
    def log_likelihoods(self, poses, beams):
        beams.ranges[:] = 0.0
        return np.zeros(len(poses))


class Stays:
    def __init__(self, settings):
        pass

    def moved(self, poses, base_before, base_now, rng):
        return poses


class OwnChance(Stays):
    def moved(self, poses, base_before, base_now, rng):
        return poses + np.random.default_rng().random(poses.shape)


@pytest.fixture(autouse=True)
def module(monkeypatch):
    monkeypatch.setitem(sys.modules, "own.faulty", sys.modules[__name__])


@pytest.mark.parametrize(("model", "check"), product(SENSOR_MODELS, SENSOR_CHECKS))
def test_a_sensor_model_of_amcl_passes(model, check):
    check(LocalizerSettings(sensor_model=model))


@pytest.mark.parametrize(("model", "check"), product(MOTION_MODELS, MOTION_CHECKS))
def test_a_motion_model_of_amcl_passes(model, check):
    check(LocalizerSettings(motion_model=model))


@pytest.mark.parametrize(
    ("model", "line"),
    [
        ("Indifferent", "FAIL  A scan is more likely at its true pose"),
        ("NotOutside", "FAIL  It returns finite log-likelihoods for any scan"),
        ("ByChance", "FAIL  Equal calls return equal results."),
        ("Scribbles", "FAIL  It does not modify its inputs."),
        ("Stays", "FAIL  The mean motion of the particles is that of the odometry"),
        ("OwnChance", "FAIL  All randomness comes from rng"),
    ],
)
def test_a_failed_check_is_reported(model, line, capsys):
    assert run_checks("amcl_lite", CHECK_SUITES, [f"own.faulty/{model}"]) == 1
    assert line in capsys.readouterr().out


def test_what_is_neither_model_is_refused_with_what_it_lacks(capsys):
    assert run_checks("amcl_lite", CHECK_SUITES, ["own.faulty/Indefinite"]) == 2
    assert "no Indefinite in" in capsys.readouterr().err
