"""The project's own matcher passes the checks that other people's have to; what errs does not."""

import sys
from dataclasses import replace

import numpy as np
import pytest

from planar import Pose2
from planar.contract_check import run_checks
from slam_lite.check import CHECKS, KITS
from slam_lite.config import MapperSettings
from slam_lite.matching.local_map import Match
from slam_lite.matching.scan_matcher import CorrelativeMatcher


class BelievesOdometry(CorrelativeMatcher):
    def match(self, surface, local_map, prediction):
        return Match(prediction.base_pose, prediction.information, 1.0)


class NeedsPoints(CorrelativeMatcher):
    def match(self, *given):
        found = super().match(*given)
        return replace(found, response=found.response if len(given[0]) else np.nan)


class Drifts(CorrelativeMatcher):
    def match(self, *given):
        found = super().match(*given)
        return replace(found, base_pose=found.base_pose @ Pose2(0.1, 0.0))


class ByChance(CorrelativeMatcher):
    def match(self, *given):
        found = super().match(*given)
        return replace(found, base_pose=found.base_pose @ Pose2(np.random.default_rng().random() * 1e-3, 0.0))


@pytest.fixture(autouse=True)
def module(monkeypatch):
    monkeypatch.setitem(sys.modules, "own.erring", sys.modules[__name__])


@pytest.mark.parametrize("check", CHECKS)
def test_the_matcher_of_the_project_passes(check):
    check(MapperSettings())


@pytest.mark.parametrize(
    ("matcher", "said"),
    [
        ("BelievesOdometry", "FAIL  It finds where a scan was made"),
        ("BelievesOdometry", "FAIL  The response to a scan of somewhere else is smaller"),
        ("NeedsPoints", "FAIL  A scan without a point leaves the prediction"),
        ("Drifts", "FAIL  Along a corridor, where nothing is seen, it believes odometry."),
        ("ByChance", "FAIL  The same calls give the same answers."),
    ],
)
def test_what_a_matcher_does_not_do_is_said(matcher, said, capsys):
    assert run_checks("slam_lite", KITS, [f"own.erring/{matcher}"]) == 1
    assert said in capsys.readouterr().out
