"""The project's own kinds of faults pass the checks that other people's have to; what errs does not."""

import sys
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from planar import Pose2
from planar.contract_check import run_checks
from sim_bridge.check import CHECKS, KITS
from sim_bridge.faults import KINDS
from sim_bridge.faults.kind import FaultKind


class Nameless(FaultKind):
    pass


class Misshapen(FaultKind):
    """Odometry is told as a pose."""

    def odometry(self, odometry):
        return Pose2()


class OnlyWeak(FaultKind):
    """Fails where it is strongest."""

    def wheel_speeds(self, left, right):
        return left / (1.0 - self._strength), right

    strength = (0.5, 0.0, 1.0)


class Scribbles(FaultKind):
    """Halves the ranges where they are."""

    def scan(self, scan):
        scan.ranges[:] *= 0.5
        return scan


class ByChance(FaultKind):
    """Adds noise of its own."""

    def scan(self, scan):
        return replace(scan, ranges=scan.ranges + np.random.default_rng().random(len(scan.ranges)) * 0.1)


@pytest.fixture(autouse=True)
def module(monkeypatch):
    monkeypatch.setitem(sys.modules, "custom.faulty", sys.modules[__name__])


@pytest.mark.parametrize(("kind", "check"), product(KINDS, CHECKS))
def test_a_kind_of_the_project_passes(kind, check):
    check(kind)


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("Nameless", "FAIL  Its docstring says in a line what goes wrong."),
        ("Misshapen", "FAIL  With its usual, least and largest strength"),
        ("OnlyWeak", "FAIL  With its usual, least and largest strength"),
        ("Scribbles", "FAIL  What it is given stays as it was"),
        ("ByChance", "FAIL  All chance comes from rng"),
    ],
)
def test_what_a_kind_does_not_do_is_said(kind, said, capsys):
    assert run_checks("sim_bridge", KITS, [f"custom.faulty/{kind}"]) == 1
    assert said in capsys.readouterr().out
