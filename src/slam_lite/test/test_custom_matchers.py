"""Custom matchers are held to their contract, and errors name them."""

import sys
import types
from dataclasses import replace

import numpy as np
import pytest

from planar import Pose2, SettingsError
from slam_lite.config import MapperSettings
from slam_lite.map_localizer import MapLocalizer
from slam_lite.mapper import Mapper
from slam_lite.matching.refinement import refine
from slam_lite.matching.scan_matcher import CorrelativeMatcher, MatchingError


class Near:
    """No window, only the lines that points lie on."""

    def __init__(self, settings):
        pass

    def match(self, cloud, local_map, prediction):
        return refine(cloud, local_map, prediction.base_pose, prediction.base_pose, prediction.information)


class Same(CorrelativeMatcher):
    """As the default one."""


class FailsOnce(Near):
    calls = 0

    def match(self, *given):
        FailsOnce.calls += 1
        if FailsOnce.calls == 3:
            raise ValueError("not now")
        return super().match(*given)


class WritesToTheScan(Near):
    def match(self, cloud, local_map, prediction):
        cloud.points_xy[:] = 0.0


class WritesToTheMap(Near):
    def match(self, cloud, local_map, prediction):
        local_map.add(cloud, prediction.base_pose)


class ReturnsNone(Near):
    def match(self, cloud, local_map, prediction):
        return None


def giving(**changes):
    class Wrong(Near):
        def match(self, *given):
            return replace(super().match(*given), **changes)

    return Wrong


Far, NoNumber = giving(base_pose=Pose2(1e300, 0.0)), giving(base_pose=Pose2(np.nan, 0.0))
Bare, Shapeless = giving(base_pose=(0.0, 0.0, 0.0)), giving(information=np.eye(2))
Negative, Unsure = giving(information=-np.eye(3)), giving(response=np.nan)


class CannotBeMade(Near):
    def __init__(self, settings):
        raise OSError("no weights.npz")


class DoesNotMatch:
    def __init__(self, settings):
        pass


@pytest.fixture(autouse=True)
def module(monkeypatch):
    """This module under a dotted name."""
    custom = types.ModuleType("custom.matchers")
    custom.__file__ = __file__
    for name, kind in globals().items():
        if isinstance(kind, type):
            setattr(custom, name, kind)
    monkeypatch.setitem(sys.modules, "custom.matchers", custom)
    monkeypatch.setattr(FailsOnce, "calls", 0)


def mapped(office, matcher, scans=60):
    """A mapper after a drive through the office, and its final position error [m]."""
    mapper = Mapper(MapperSettings(matcher_plugin=f"custom.matchers/{matcher}" if matcher else ""))
    for observation in office.drive(laps=0.3)[:scans]:
        update = mapper.insert(observation.base_in_odom, observation.scan)
        if update is not None:
            last = update, observation
    update, observation = last
    return mapper, update.base_in_map.distance_to(observation.base_in_map)


def test_it_replaces_the_default_one(office):
    _, error = mapped(office, "Near")
    assert error < 0.1


def test_the_guard_changes_nothing(office):
    custom, official = mapped(office, "Same", scans=30)[0], mapped(office, "", scans=30)[0]
    assert np.array_equal(custom.keyframe_poses, official.keyframe_poses)


@pytest.mark.parametrize(
    ("matcher", "fault"),
    [
        ("FailsOnce", "raised ValueError: not now"),
        ("WritesToTheScan", "raised ValueError: assignment destination is read-only"),
        ("WritesToTheMap", "raised "),
        ("ReturnsNone", "returned a NoneType, not a Match"),
        ("Far", "returned a base_pose that is not a Pose2 in range"),
        ("NoNumber", "returned a base_pose that is not a Pose2 in range"),
        ("Bare", "returned a base_pose that is not a Pose2 in range: (0.0, 0.0, 0.0)"),
        ("Shapeless", "returned an information that is not a (3, 3) array of finite numbers"),
        ("Negative", "returned an information that is not symmetric and positive semi-definite"),
        ("Unsure", "returned a response of nan, not between 0 and 1"),
        ("CannotBeMade", "raised OSError: no weights.npz"),
    ],
)
def test_errors_name_the_matcher(office, matcher, fault):
    with pytest.raises(MatchingError) as raised:
        mapped(office, matcher, scans=4)
    assert str(raised.value).startswith(f"custom.matchers/{matcher} {fault}")


def test_tracking_continues_after_a_scan_at_which_it_failed(office):
    mapper = Mapper(MapperSettings(matcher_plugin="custom.matchers/FailsOnce"))
    failed = []
    for observation in office.drive(laps=0.3):
        try:
            update = mapper.insert(observation.base_in_odom, observation.scan)
        except MatchingError:
            failed.append(observation)
    assert len(failed) == 1
    assert update.base_in_map.distance_to(observation.base_in_map) < 0.1


def test_the_localizer_uses_it_too(office):
    mapper, _ = mapped(office, "")
    settings = MapperSettings(matcher_plugin="custom.matchers/ReturnsNone")
    first = office.drive(laps=0.3)[0]
    with pytest.raises(MatchingError, match="ReturnsNone returned a NoneType"):
        MapLocalizer(settings, mapper.state(), first.base_in_map).insert(first.base_in_odom, first.scan)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("no_such.module/Matcher", "no module no_such on Python's path"),
        (
            "custom.matchers/DoesNotMatch",
            "is no scan matcher: it has no match(cloud, local_map, prediction)",
        ),
        ("Matcher", "matcher_plugin must be like my_package.my_module/MyMatcher, got 'Matcher'"),
    ],
)
def test_an_unusable_matcher_is_refused(name, reason):
    with pytest.raises(SettingsError) as refused:
        MapperSettings(matcher_plugin=name)
    assert reason in str(refused.value)
