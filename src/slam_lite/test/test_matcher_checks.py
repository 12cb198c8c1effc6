"""The default matcher passes the checks of custom ones; faulty ones do not."""

import sys
from dataclasses import replace

import numpy as np
import pytest

from planar import Pose2
from planar.extensions.check import run_checks
from slam_lite.check import CHECK_SUITES, CHECKS
from slam_lite.config import MapperSettings
from slam_lite.matching.local_map import Match
from slam_lite.matching.scan_matcher import CorrelativeMatcher


class ReturnsOdometry(CorrelativeMatcher):
    def match(self, cloud, local_map, prediction):
        return Match(prediction.base_pose, prediction.information, 1.0)


class NeedsPoints(CorrelativeMatcher):
    def match(self, *arguments):
        match = super().match(*arguments)
        return replace(match, response=match.response if len(arguments[0]) else np.nan)


class Drifts(CorrelativeMatcher):
    def match(self, *arguments):
        match = super().match(*arguments)
        return replace(match, base_pose=match.base_pose @ Pose2(0.1, 0.0))


class ByChance(CorrelativeMatcher):
    def match(self, *arguments):
        match = super().match(*arguments)
        return replace(match, base_pose=match.base_pose @ Pose2(np.random.default_rng().random() * 1e-3, 0.0))


@pytest.fixture(autouse=True)
def module(monkeypatch):
    monkeypatch.setitem(sys.modules, "custom.faulty", sys.modules[__name__])


@pytest.mark.parametrize("check", CHECKS)
def test_the_default_matcher_passes(check):
    check(MapperSettings())


@pytest.mark.parametrize(
    ("matcher", "output"),
    [
        ("ReturnsOdometry", "FAIL  It finds the pose of a scan to 3 cm"),
        ("ReturnsOdometry", "FAIL  The response to a scan of another place is lower"),
        ("NeedsPoints", "FAIL  A scan without points leaves the prediction"),
        ("Drifts", "FAIL  Along a smooth corridor, which scans do not measure, it follows odometry."),
        ("ByChance", "FAIL  The same calls give the same results."),
    ],
)
def test_a_faulty_matcher_fails_the_check(matcher, output, capsys):
    assert run_checks("slam_lite", CHECK_SUITES, [f"custom.faulty/{matcher}"]) == 1
    assert output in capsys.readouterr().out
