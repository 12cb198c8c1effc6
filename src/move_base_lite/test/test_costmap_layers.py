"""The contract of layers: what any of them, whoever wrote it, has to do; and one of one's own."""

from dataclasses import dataclass

import numpy as np
import pytest

from move_base_lite.costmap import (
    LAYERS,
    LETHAL,
    CostmapSettings,
    Footprint,
    Layer,
    LayeredCostmap,
    LayerSettings,
    Placement,
    Site,
    Window,
    footprint_from,
    sighting_of_points,
)
from move_base_lite.costmap.layers.obstacles import SourceSettings
from move_base_lite.plugin import Plugin, Registry
from planar import Pose2, grid_from_picture
from planar.config.parameters import parameter

GRID = grid_from_picture("#....\n.....\n..#..", 0.2)
WINDOW = Window(GRID.rows, GRID.cols, GRID.resolution)
FOOTPRINT: Footprint = footprint_from((), 0.05, 0.0)
HERE = Pose2(0.5, 0.3)


@pytest.fixture(params=LAYERS.members, ids=lambda member: member.short_name)
def member(request):
    return request.param


def settings_of(member):
    """The defaults, with a sensor if the layer has any."""
    sources = {"sources": (SourceSettings(topic="cloud"),)}
    return member.settings(**(sources if hasattr(member.settings(), "sources") else {}))


def seen_by(member, is_rolling=False):
    """A layer that has been shown something beside the robot, and what it said to have changed."""
    layer = member.make(settings_of(member), Site(WINDOW, is_rolling, FOOTPRINT, GRID))
    layer.note(sighting_of_points("cloud", 0.0, Pose2(), np.array([[0.2, 0.0, 0.1]])), HERE)
    return layer, layer.update(Placement(WINDOW, 0, 0, HERE, Pose2()))


def applied(layer, bounds=WINDOW.everything, ground=0):
    costs = np.full((WINDOW.rows, WINDOW.cols), ground, np.uint8)
    costs[0, 0] = LETHAL
    layer.apply(costs, WINDOW, bounds)
    return costs


@pytest.mark.parametrize("is_rolling", [False, True])
def test_a_layer_changes_no_cell_outside_of_the_bounds(member, is_rolling):
    layer, _ = seen_by(member, is_rolling)
    bounds = WINDOW.cut(WINDOW.bounds_around(HERE.x, HERE.y, 0.1))
    outside = np.ones((WINDOW.rows, WINDOW.cols), bool)
    outside[bounds.slices] = False
    ground = applied(Layer_without_effect())
    np.testing.assert_array_equal(applied(layer, bounds)[outside], ground[outside])


def test_a_layer_applied_twice_gives_the_same(member):
    layer, _ = seen_by(member)
    costs = applied(layer)
    np.testing.assert_array_equal(costs, applied(layer))


def test_an_update_tells_of_all_that_has_changed(member):
    fresh = member.make(settings_of(member), Site(WINDOW, False, FOOTPRINT, GRID))
    before = applied(fresh)
    layer, changed = seen_by(member)
    rows, cols = np.nonzero(before != applied(layer))
    block = WINDOW.grown(changed, layer.reach_cells)
    assert all(block.row_min <= row < block.row_max for row in rows)
    assert all(block.col_min <= col < block.col_max for col in cols)


def test_a_layer_that_forgets_shows_what_it_would_have_shown_anew(member):
    layer, _ = seen_by(member)
    layer.clear_outside(WINDOW.cut(WINDOW.bounds_around(-9.0, -9.0, 0.1)), WINDOW)
    anew = member.make(settings_of(member), Site(WINDOW, False, FOOTPRINT, GRID))
    np.testing.assert_array_equal(applied(layer), applied(anew))


class Layer_without_effect(Layer):  # noqa: N801
    def apply(self, costs, window, bounds):
        pass


@dataclass(frozen=True)
class LineSettings(LayerSettings):
    col: int = parameter(3, "that must not be crossed")


class LineLayer(Layer):
    """A layer of somebody's own."""

    def __init__(self, settings, site):
        self._col = settings.col

    def apply(self, costs, window, bounds):
        costs[bounds.row_min : bounds.row_max, self._col] = LETHAL


def test_a_layer_of_ones_own_lies_below_inflation(monkeypatch):
    line = Plugin("mine::LineLayer", LineSettings, LineLayer)
    monkeypatch.setattr("move_base_lite.costmap.costmap.LAYERS", Registry(*LAYERS.members, line))
    costmap = LayeredCostmap(CostmapSettings(width=1.0, height=1.0, own_layers=(LineSettings(col=4),)))
    assert (costmap.costs[:, 4] == LETHAL).all()
    assert (costmap.costs[:, [3, 5]] > 0).all()
