"""Contract checks of costmap layers."""

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
from planar import Pose2, grid_from_picture
from planar.extensions import Plugin
from planar.extensions.check import expect

GRID = grid_from_picture("#....\n.....\n..#..", 0.2)
WINDOW = CostmapWindow(GRID.rows, GRID.cols, GRID.resolution)
FOOTPRINT: Footprint = footprint_from((), 0.05, 0.0)
HERE = Pose2(0.5, 0.3)


def stays_within_bounds(plugin: Plugin[Any]) -> None:
    """It changes no cell outside of the bounds."""
    for is_rolling in (False, True):
        layer, _ = _with_observation(plugin, is_rolling)
        bounds = WINDOW.cut(WINDOW.bounds_around(HERE.x, HERE.y, 0.1))
        outside = np.ones((WINDOW.rows, WINDOW.cols), bool)
        outside[bounds.slices] = False
        costs = _applied(layer, bounds)
        expect(np.array_equal(costs[outside], _base_costs()[outside]), f"cells outside of {bounds} changed")


def is_repeatable(plugin: Plugin[Any]) -> None:
    """Applying it twice gives the same costs."""
    layer, _ = _with_observation(plugin)
    expect(np.array_equal(_applied(layer), _applied(layer)), "other costs the second time")


def reports_changed_bounds(plugin: Plugin[Any]) -> None:
    """An update returns bounds that contain all changed cells."""
    before = _applied(_new_layer(plugin))
    layer, changed = _with_observation(plugin)
    has_changed = before != _applied(layer)
    block = WINDOW.grown(changed, layer.reach_cells)
    has_changed[block.slices] = False
    expect(not has_changed.any(), f"cells outside of {block} changed")


def clears_observations(plugin: Plugin[Any]) -> None:
    """After clear_outside of everything it gives the costs of a new layer."""
    layer, _ = _with_observation(plugin)
    layer.clear_outside(WINDOW.cut(WINDOW.bounds_around(-9.0, -9.0, 0.1)), WINDOW)
    expect(
        np.array_equal(_applied(layer), _applied(_new_layer(plugin))), "an observation is left after clearing"
    )


def _new_layer(plugin: Plugin[Any], is_rolling: bool = False) -> Layer:
    """A layer with default settings, and with a sensor if it has sources."""
    has_sources = hasattr(plugin.settings(), "sources")
    settings = plugin.settings(sources=(SourceSettings(topic="cloud"),)) if has_sources else plugin.settings()
    return plugin.make(settings, LayerContext(WINDOW, is_rolling, FOOTPRINT, GRID))


def _with_observation(plugin: Plugin[Any], is_rolling: bool = False) -> Tuple[Layer, CellBounds]:
    """A layer after an observation beside the robot, and the changed bounds it returned."""
    layer = _new_layer(plugin, is_rolling)
    layer.add_observation(observation_from_points("cloud", 0.0, Pose2(), np.array([[0.2, 0.0, 0.1]])), HERE)
    return layer, layer.update(CostmapPlacement(WINDOW, 0, 0, HERE, Pose2()))


def _base_costs() -> np.ndarray:
    costs = np.zeros((WINDOW.rows, WINDOW.cols), np.uint8)
    costs[0, 0] = LETHAL
    return costs


def _applied(layer: Layer, bounds: Optional[CellBounds] = None) -> np.ndarray:
    costs = _base_costs()
    layer.apply(costs, WINDOW, bounds or WINDOW.everything)
    return costs


CHECKS = (stays_within_bounds, is_repeatable, reports_changed_bounds, clears_observations)
