"""User-defined models are checked against their contracts, and errors name the model."""

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


class HasNoMethods:
    def __init__(self, grid, settings):
        pass


class Exact:
    """Odometry without noise."""

    def __init__(self, settings):
        pass

    def moved(self, poses, base_before, base_now, rng):
        return np.array(
            [(Pose2.from_array(pose) @ base_before.inverse() @ base_now).as_array() for pose in poses]
        )


class StopsOnce(Exact):
    """Fails when it is asked for the first time."""

    asked = 0

    def moved(self, *given):
        StopsOnce.asked += 1
        if StopsOnce.asked == 1:
            raise ValueError("not now")
        return super().moved(*given)


class GoesFar(Exact):
    def moved(self, poses, base_before, base_now, rng):
        return poses + 1e300


class LosesSome(Exact):
    def moved(self, poses, base_before, base_now, rng):
        return poses[:-1]


class MovesInPlace(Exact):
    def moved(self, poses, base_before, base_now, rng):
        poses[:] = 0.0
        return poses


class DoesNotMove:
    def __init__(self, settings):
        pass


def named(kind):
    return f"own.models/{kind.__name__}"


@pytest.fixture(autouse=True)
def module(monkeypatch):
    """This module under a dotted name."""
    import sys
    import types

    own = types.ModuleType("own.models")
    own.__file__ = __file__
    for kind in (each for each in globals().values() if isinstance(each, type)):
        setattr(own, kind.__name__, kind)
    monkeypatch.setitem(sys.modules, "own.models", own)


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
        (AnswersNan, "returned no 200 finite numbers"),
        (AnswersLess, "returned no 200 finite numbers"),
        (CannotBeMade, "raised OSError: no weights.npz"),
        (Scribbles, "raised ValueError: assignment destination is read-only"),
    ],
)
def test_an_error_of_a_sensor_model_names_it(kind, fault):
    with pytest.raises(LocalizationError) as raised:
        updated(kind)
    assert str(raised.value) == f"{named(kind)} {fault}"


def test_it_cannot_move_the_particles():
    settings = LocalizerSettings(sensor_plugin=named(Scribbles), max_particles=200)
    localizer = Localizer(GRID, settings, np.random.default_rng(0))
    localizer.set_pose(Pose2(1.0, 1.0), np.diag([0.01, 0.01, 0.01]))
    before = localizer.particles.poses.copy()
    with pytest.raises(LocalizationError):
        localizer.update(Pose2(), SCAN)
    assert np.array_equal(localizer.particles.poses, before)


def standing(kind):
    """A localizer whose particles stand at (1, 1) after a scan."""
    settings = LocalizerSettings(motion_plugin=named(kind), max_particles=200, refine_pose=False)
    localizer = Localizer(GRID, settings, np.random.default_rng(0))
    localizer.set_pose(Pose2(1.0, 1.0), np.zeros((3, 3)))
    localizer.update(Pose2(), SCAN)
    return localizer


def test_a_motion_model_takes_the_place_of_the_others():
    localizer = standing(Exact)
    localizer.update(Pose2(0.5, 0.0), SCAN)
    assert localizer.particles.poses[:, 0] == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("kind", "fault"),
    [
        (StopsOnce, "raised ValueError: not now"),
        (GoesFar, "returned no 200 by 3 finite numbers up to 1e+06"),
        (LosesSome, "returned no 200 by 3 finite numbers"),
        (MovesInPlace, "raised ValueError: assignment destination is read-only"),
    ],
)
def test_an_error_of_a_motion_model_names_it(kind, fault, monkeypatch):
    monkeypatch.setattr(StopsOnce, "asked", 0)
    with pytest.raises(LocalizationError) as raised:
        standing(kind).update(Pose2(0.5, 0.0), SCAN)
    assert str(raised.value).startswith(f"{named(kind)} {fault}")


def test_a_motion_that_could_not_be_followed_is_followed_at_the_next_scan(monkeypatch):
    monkeypatch.setattr(StopsOnce, "asked", 0)
    localizer = standing(StopsOnce)
    with pytest.raises(LocalizationError):
        localizer.update(Pose2(0.5, 0.0), SCAN)
    assert localizer.particles.poses[0] == pytest.approx((1.0, 1.0, 0.0))
    localizer.update(Pose2(0.6, 0.0), SCAN)
    assert localizer.particles.poses[0] == pytest.approx((1.6, 1.0, 0.0))


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("no_such.module/Model", "no module no_such on Python's path"),
        ("own.models/HasNoMethods", "is no sensor model: it has no log_likelihoods(poses, beams)"),
        ("Model", "sensor_plugin must be like my_package.my_module/MyModel, got 'Model'"),
    ],
)
def test_what_cannot_be_used_is_refused(name, reason):
    with pytest.raises(SettingsError) as refused:
        LocalizerSettings(sensor_plugin=name)
    assert reason in str(refused.value)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        (
            "own.models/DoesNotMove",
            "is no motion model: it has no moved(poses, base_before, base_now, rng)",
        ),
        ("Model", "motion_plugin must be like my_package.my_module/MyModel, got 'Model'"),
    ],
)
def test_a_motion_model_that_cannot_be_used_is_refused(name, reason):
    with pytest.raises(SettingsError) as refused:
        LocalizerSettings(motion_plugin=name)
    assert reason in str(refused.value)
