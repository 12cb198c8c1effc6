"""The project's own generators pass the checks that other people's have to; what errs does not."""

import sys
from dataclasses import dataclass
from itertools import product

import numpy as np
import pytest

from laboratory.check import CHECKS, KITS
from laboratory.generators.crossings import CrossingCylinders
from laboratory.generators.fields import CylinderFields
from laboratory.generators.homes import Homes
from laboratory.worlds.solids import FLOOR, wall
from laboratory.worlds.source import Arena
from planar import OccupancyGrid, Pose2
from planar.maps.places import NamedPlace
from planar.plugin_check import run_checks
from sim_bridge.world import World


@dataclass(frozen=True)
class Bare:
    def arena(self, seed: int) -> Arena:
        return Arena(World("nothing", ()))


@dataclass(frozen=True)
class ByChance:
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
    monkeypatch.setitem(sys.modules, "own.erring", sys.modules[__name__])


@pytest.mark.parametrize(
    ("source", "check"), product((Homes(), CylinderFields(), CrossingCylinders()), CHECKS)
)
def test_a_generator_of_the_project_passes(source, check):
    check(source)


@pytest.mark.parametrize(
    ("generator", "said"),
    [
        ("Bare", "FAIL  It gives a world for each seed"),
        ("ByChance", "FAIL  All chance comes from the seed"),
        ("InTheWall", "FAIL  Its places are on free floor"),
    ],
)
def test_what_a_generator_does_not_do_is_said(generator, said, capsys):
    assert run_checks("laboratory", KITS, [f"own.erring/{generator}"]) == 1
    assert said in capsys.readouterr().out


def test_a_generator_without_values_of_its_own_cannot_be_tried(capsys):
    assert run_checks("laboratory", KITS, ["own.erring/Needs"]) == 2
    assert "own.erring/Needs cannot be tried: " in capsys.readouterr().err
