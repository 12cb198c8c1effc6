"""The included generators pass the contract checks, and generators that violate the contract do not."""

import sys
from dataclasses import dataclass
from itertools import product

import numpy as np
import pytest

from laboratory.check import CHECK_SUITES, CHECKS
from laboratory.generators.crossings import CrossingCylinders
from laboratory.generators.fields import CylinderFields
from laboratory.generators.homes import Homes
from laboratory.worlds.solids import FLOOR, wall
from laboratory.worlds.source import Arena
from planar import OccupancyGrid, Pose2
from planar.extensions.check import run_checks
from planar.maps.places import NamedPlace
from sim_bridge.world import World


@dataclass(frozen=True)
class Bare:
    def arena(self, seed: int) -> Arena:
        return Arena(World("nothing", ()))


@dataclass(frozen=True)
class Unseeded:
    def arena(self, seed: int) -> Arena:
        x = 2.0 + float(np.random.default_rng().random())
        return Arena(World("wall", (FLOOR, wall("wall", x, 0.0, 0.1, 3.0))))


@dataclass(frozen=True)
class InTheWall:
    def arena(self, seed: int) -> Arena:
        grid = OccupancyGrid(np.full((20, 20), 100, np.int8), 0.1)
        return Arena(World("room", (FLOOR,)), grid, places=(NamedPlace("desk", Pose2(1.0, 1.0)),))


@dataclass(frozen=True)
class Needs:
    rooms: int

    def arena(self, seed: int) -> Arena:
        return Arena(World("room", (FLOOR,)))


@pytest.fixture(autouse=True)
def module(monkeypatch):
    monkeypatch.setitem(sys.modules, "custom.faulty", sys.modules[__name__])


@pytest.mark.parametrize(
    ("source", "check"), product((Homes(), CylinderFields(), CrossingCylinders()), CHECKS)
)
def test_the_included_generators_pass(source, check):
    check(source)


@pytest.mark.parametrize(
    ("generator", "message"),
    [
        ("Bare", "FAIL  It generates a world with a floor for each seed"),
        ("Unseeded", "FAIL  It is deterministic"),
        ("InTheWall", "FAIL  Its places are on free cells"),
    ],
)
def test_a_violated_contract_is_reported(generator, message, capsys):
    assert run_checks("laboratory", CHECK_SUITES, [f"custom.faulty/{generator}"]) == 1
    assert message in capsys.readouterr().out


def test_a_generator_whose_fields_have_no_defaults_cannot_be_checked(capsys):
    assert run_checks("laboratory", CHECK_SUITES, ["custom.faulty/Needs"]) == 2
    assert "custom.faulty/Needs cannot be checked without arguments: " in capsys.readouterr().err
