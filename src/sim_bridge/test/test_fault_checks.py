"""The project's kinds of faults pass the checks of user-defined ones; faulty kinds fail them."""

import sys
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from planar import Pose2
from planar.extensions.check import run_checks
from sim_bridge.check import CHECK_SUITES, CHECKS
from sim_bridge.faults import KINDS
from sim_bridge.faults.kind import FaultKind


class Undocumented(FaultKind):
    pass


class WrongType(FaultKind):
    """Returns a pose as odometry."""

    def odometry(self, odometry):
        return Pose2()


class FailsAtLargest(FaultKind):
    """Fails at its largest strength."""

    def wheel_speeds(self, left, right):
        return left / (1.0 - self._strength), right

    strength = (0.5, 0.0, 1.0)


class ChangesInPlace(FaultKind):
    """Halves the ranges in place."""

    def scan(self, scan):
        scan.ranges[:] *= 0.5
        return scan


class Unseeded(FaultKind):
    """Adds noise of an unseeded generator."""

    def scan(self, scan):
        return replace(scan, ranges=scan.ranges + np.random.default_rng().random(len(scan.ranges)) * 0.1)


@pytest.fixture(autouse=True)
def custom_module(monkeypatch):
    monkeypatch.setitem(sys.modules, "custom.faulty", sys.modules[__name__])


@pytest.mark.parametrize(("kind", "check"), product(KINDS, CHECKS))
def test_a_kind_of_the_project_passes(kind, check):
    check(kind)


@pytest.mark.parametrize(
    ("kind", "report"),
    [
        ("Undocumented", "FAIL  The first line of its docstring states the effect."),
        ("WrongType", "FAIL  It returns valid values at its default, least and largest strength."),
        ("FailsAtLargest", "FAIL  It returns valid values at its default, least and largest strength."),
        ("ChangesInPlace", "FAIL  It does not change its arguments"),
        ("Unseeded", "FAIL  Its randomness is from rng"),
    ],
)
def test_a_failed_check_is_reported(kind, report, capsys):
    assert run_checks("sim_bridge", CHECK_SUITES, [f"custom.faulty/{kind}"]) == 1
    assert report in capsys.readouterr().out
