"""The checks of costmap layers."""

from typing import Any, Optional, Tuple

import numpy as np

from move_base_lite.costmap import (
    LETHAL,
    CostmapPlacement,
    CostmapWindow,
    Footprint,
    Layer,
    LayerContext,
    footprint_from,
    observation_from_points,
)
from move_base_lite.costmap.layers.obstacles import SourceSettings
from move_base_lite.costmap.window import CellBounds
from move_base_lite.plugin import Plugin
from planar import Pose2, grid_from_picture
from planar.contract_check import expect

GRID = grid_from_picture("#....\n.....\n..#..", 0.2)
WINDOW = CostmapWindow(GRID.rows, GRID.cols, GRID.resolution)
FOOTPRINT: Footprint = footprint_from((), 0.05, 0.0)
HERE = Pose2(0.5, 0.3)


def keeps_to_its_bounds(plugin: Plugin[Any]) -> None:
    """It changes no cell outside of the bounds."""
    for is_rolling in (False, True):
        layer, _ = _shown(plugin, is_rolling)
        bounds = WINDOW.cut(WINDOW.bounds_around(HERE.x, HERE.y, 0.1))
        outside = np.ones((WINDOW.rows, WINDOW.cols), bool)
        outside[bounds.slices] = False
        costs = _applied(layer, bounds)
        expect(np.array_equal(costs[outside], _ground()[outside]), f"cells outside of {bounds} changed")


def is_repeatable(plugin: Plugin[Any]) -> None:
    """Applied twice it gives the same."""
    layer, _ = _shown(plugin)
    expect(np.array_equal(_applied(layer), _applied(layer)), "other costs the second time")


def reports_changed_bounds(plugin: Plugin[Any]) -> None:
    """An update tells of all that has changed."""
    before = _applied(_made(plugin))
    layer, changed = _shown(plugin)
    has_changed = before != _applied(layer)
    block = WINDOW.grown(changed, layer.reach_cells)
    has_changed[block.slices] = False
    expect(not has_changed.any(), f"cells outside of {block} changed")


def clears_observations(plugin: Plugin[Any]) -> None:
    """What forgets shows what it would have shown anew."""
    layer, _ = _shown(plugin)
    layer.clear_outside(WINDOW.cut(WINDOW.bounds_around(-9.0, -9.0, 0.1)), WINDOW)
    expect(np.array_equal(_applied(layer), _applied(_made(plugin))), "something is left of what was seen")


def _made(plugin: Plugin[Any], is_rolling: bool = False) -> Layer:
    """With the defaults, and a sensor if the layer has any."""
    has_sources = hasattr(plugin.settings(), "sources")
    settings = plugin.settings(sources=(SourceSettings(topic="cloud"),)) if has_sources else plugin.settings()
    return plugin.make(settings, LayerContext(WINDOW, is_rolling, FOOTPRINT, GRID))


def _shown(plugin: Plugin[Any], is_rolling: bool = False) -> Tuple[Layer, CellBounds]:
    """A layer that has been shown something beside the robot, and what it said to have changed."""
    layer = _made(plugin, is_rolling)
    layer.add_observation(observation_from_points("cloud", 0.0, Pose2(), np.array([[0.2, 0.0, 0.1]])), HERE)
    return layer, layer.update(CostmapPlacement(WINDOW, 0, 0, HERE, Pose2()))


def _ground() -> np.ndarray:
    costs = np.zeros((WINDOW.rows, WINDOW.cols), np.uint8)
    costs[0, 0] = LETHAL
    return costs


def _applied(layer: Layer, bounds: Optional[CellBounds] = None) -> np.ndarray:
    costs = _ground()
    layer.apply(costs, WINDOW, bounds or WINDOW.everything)
    return costs


CHECKS = (keeps_to_its_bounds, is_repeatable, reports_changed_bounds, clears_observations)
