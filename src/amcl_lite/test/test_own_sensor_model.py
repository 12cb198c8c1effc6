"""A sensor model of somebody's own is held to its contract, and what it does wrong is told in its name."""

import numpy as np
import pytest

from amcl_lite import LocalizationError, Localizer, LocalizerSettings
from planar import Pose2, Scan, SettingsError, grid_from_picture

GRID = grid_from_picture("######\n#....#\n#....#\n######", 0.5)
SCAN = Scan(0.0, -1.0, 0.5, np.full(5, 0.5, dtype=np.float32), 0.1, 2.0)


class Even:
    """Everywhere is as likely."""

    def __init__(self, grid, settings):
        pass

    def log_likelihoods(self, poses, beams):
        return np.zeros(len(poses))


class Raises(Even):
    def log_likelihoods(self, poses, beams):
        raise ZeroDivisionError("division by zero")


class AnswersNan(Even):
    def log_likelihoods(self, poses, beams):
        return np.full(len(poses), np.nan)


class AnswersLess(Even):
    def log_likelihoods(self, poses, beams):
        return np.zeros(1)


class CannotBeMade(Even):
    def __init__(self, grid, settings):
        raise OSError("no weights.npz")


class Scribbles(Even):
    def log_likelihoods(self, poses, beams):
        poses[:] = 0.0
        return np.zeros(len(poses))


class TellsNothing:
    def __init__(self, grid, settings):
        pass


def named(kind):
    return f"own.sensors/{kind.__name__}"


@pytest.fixture(autouse=True)
def module(monkeypatch):
    """This module under a dotted name."""
    import sys
    import types

    own = types.ModuleType("own.sensors")
    own.__file__ = __file__
    for kind in (Even, Raises, AnswersNan, AnswersLess, CannotBeMade, Scribbles, TellsNothing):
        setattr(own, kind.__name__, kind)
    monkeypatch.setitem(sys.modules, "own.sensors", own)


def updated(kind):
    settings = LocalizerSettings(sensor_plugin=named(kind), max_particles=200)
    localizer = Localizer(GRID, settings, np.random.default_rng(0))
    localizer.set_pose(Pose2(1.0, 1.0), np.diag([0.01, 0.01, 0.01]))
    return localizer, localizer.update(Pose2(), SCAN)


def test_it_takes_the_place_of_the_others():
    _, estimate = updated(Even)
    assert estimate is not None


@pytest.mark.parametrize(
    ("kind", "fault"),
    [
        (Raises, "raised ZeroDivisionError: division by zero"),
        (AnswersNan, "gave no 200 finite numbers"),
        (AnswersLess, "gave no 200 finite numbers"),
        (CannotBeMade, "raised OSError: no weights.npz"),
    ],
)
def test_what_goes_wrong_in_it_is_told_in_its_name(kind, fault):
    with pytest.raises(LocalizationError) as told:
        updated(kind)
    assert str(told.value) == f"{named(kind)} {fault}"


def test_it_cannot_move_the_particles():
    localizer, _ = updated(Scribbles)
    assert np.abs(localizer.particles.poses[:, :2] - 1.0).max() < 0.6


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("no_such.module/Model", "there is no module no_such on Python's path"),
        ("own.sensors/TellsNothing", "is no sensor model: it has no log_likelihoods(poses, beams)"),
        ("Model", "sensor_plugin must be like my_package.my_module/MyModel, got 'Model'"),
    ],
)
def test_what_cannot_be_used_is_refused(name, reason):
    with pytest.raises(SettingsError) as refused:
        LocalizerSettings(sensor_plugin=name)
    assert reason in str(refused.value)
