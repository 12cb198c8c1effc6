"""Matchers of somebody's own are held to their contract, and what they do wrong is told in their names."""

import sys
import types
from dataclasses import replace

import numpy as np
import pytest

from planar import Pose2, SettingsError
from slam_lite.config import MapperSettings
from slam_lite.mapper import Follower, Mapper
from slam_lite.matching.refinement import refine
from slam_lite.matching.scan_matcher import CorrelativeMatcher, MatchingError


class Near:
    """No window, only the lines that points lie on."""

    def __init__(self, settings):
        pass

    def match(self, surface, local_map, prediction):
        return refine(surface, local_map, prediction.base_pose, prediction.base_pose, prediction.information)


class Same(CorrelativeMatcher):
    """As the project's own."""


class FailsOnce(Near):
    asked = 0

    def match(self, *given):
        FailsOnce.asked += 1
        if FailsOnce.asked == 3:
            raise ValueError("not now")
        return super().match(*given)


class ScribblesOnTheScan(Near):
    def match(self, surface, local_map, prediction):
        surface.points_xy[:] = 0.0


class ScribblesOnTheMap(Near):
    def match(self, surface, local_map, prediction):
        local_map.add(surface, prediction.base_pose)


class TellsNothing(Near):
    def match(self, surface, local_map, prediction):
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
    own = types.ModuleType("own.matchers")
    own.__file__ = __file__
    for name, kind in globals().items():
        if isinstance(kind, type):
            setattr(own, name, kind)
    monkeypatch.setitem(sys.modules, "own.matchers", own)
    monkeypatch.setattr(FailsOnce, "asked", 0)


def mapped(office, matcher, scans=60):
    """A mapper that was driven through the office, and how far off it was in the end."""
    mapper = Mapper(MapperSettings(matcher_plugin=f"own.matchers/{matcher}" if matcher else ""))
    for sighting in office.drive(laps=0.3)[:scans]:
        update = mapper.insert(sighting.base_in_odom, sighting.scan)
        if update is not None:
            last = update, sighting
    update, sighting = last
    return mapper, update.base_in_map.distance_to(sighting.base_in_map)


def test_it_takes_the_place_of_the_projects_own(office):
    _, error = mapped(office, "Near")
    assert error < 0.1


def test_between_its_guard_and_the_map_nothing_is_lost(office):
    own, official = mapped(office, "Same", scans=30)[0], mapped(office, "", scans=30)[0]
    assert np.array_equal(own.key_poses, official.key_poses)


@pytest.mark.parametrize(
    ("matcher", "fault"),
    [
        ("FailsOnce", "raised ValueError: not now"),
        ("ScribblesOnTheScan", "raised ValueError: assignment destination is read-only"),
        ("ScribblesOnTheMap", "raised "),
        ("TellsNothing", "gave a NoneType, not a Match"),
        ("Far", "gave a base_pose at which no robot can be"),
        ("NoNumber", "gave a base_pose at which no robot can be"),
        ("Bare", "gave a base_pose at which no robot can be: (0.0, 0.0, 0.0)"),
        ("Shapeless", "gave an information that is no 3 by 3 finite numbers"),
        ("Negative", "gave an information that is not symmetric, or negative in some direction"),
        ("Unsure", "gave a response of nan, not of 0 to 1"),
        ("CannotBeMade", "raised OSError: no weights.npz"),
    ],
)
def test_what_goes_wrong_in_it_is_told_in_its_name(office, matcher, fault):
    with pytest.raises(MatchingError) as told:
        mapped(office, matcher, scans=4)
    assert str(told.value).startswith(f"own.matchers/{matcher} {fault}")


def test_after_a_scan_at_which_it_failed_the_robot_is_followed_on(office):
    mapper = Mapper(MapperSettings(matcher_plugin="own.matchers/FailsOnce"))
    failed = []
    for sighting in office.drive(laps=0.3):
        try:
            update = mapper.insert(sighting.base_in_odom, sighting.scan)
        except MatchingError:
            failed.append(sighting)
    assert len(failed) == 1
    assert update.base_in_map.distance_to(sighting.base_in_map) < 0.1


def test_a_finished_map_is_followed_with_it_too(office):
    mapper, _ = mapped(office, "")
    settings = MapperSettings(matcher_plugin="own.matchers/TellsNothing")
    first = office.drive(laps=0.3)[0]
    with pytest.raises(MatchingError, match="TellsNothing gave a NoneType"):
        Follower(settings, mapper.state(), first.base_in_map).insert(first.base_in_odom, first.scan)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("no_such.module/Matcher", "there is no module no_such on Python's path"),
        (
            "own.matchers/DoesNotMatch",
            "is no scan matcher: it has no match(surface, local_map, prediction)",
        ),
        ("Matcher", "matcher_plugin must be like my_package.my_module/MyMatcher, got 'Matcher'"),
    ],
)
def test_what_cannot_be_used_is_refused(name, reason):
    with pytest.raises(SettingsError) as refused:
        MapperSettings(matcher_plugin=name)
    assert reason in str(refused.value)
