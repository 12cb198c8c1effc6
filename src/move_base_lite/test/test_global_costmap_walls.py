"""Cost to go and clearance with walls that only the global costmap has."""

from dataclasses import replace

import numpy as np
import pytest
from costmap_with_layers import costmap_with, with_layer

from move_base_lite.check import maps
from move_base_lite.control import Plan
from move_base_lite.control.mppi.scene import scene_of
from move_base_lite.costmap import INSCRIBED, LayeredCostmap
from move_base_lite.costmap.layers.static import StaticSettings
from planar import OccupancyGrid, Pose2

AROUND_WALL = """
############
#S....#...G#
#.....#....#
#.....#....#
#.....#....#
#..........#
############"""
TURNED = Pose2(3.0, -2.0, 0.7)
START_XY = (0.75, 2.75)


@pytest.fixture
def walled(monkeypatch):
    monkeypatch.setitem(maps.PICTURES, "around_wall", AROUND_WALL)
    return maps.check_map("around_wall")


def scene_in(room, global_costmap, map_in_local, use_global_costmap=True):
    """The scene at the start with an empty local costmap, and that costmap's window."""
    nothing = OccupancyGrid(np.zeros((400, 400), np.int8), 0.05, Pose2(-10.0, -10.0, 0.0))
    near = LayeredCostmap(costmap_with(StaticSettings(), robot_radius=maps.RADIUS), nothing)
    base = Pose2(*room.start_xy, 0.0)
    context = replace(
        maps.context_of(near, map_in_local @ base), base_in_map=base, global_costmap=global_costmap
    )
    path_xy = map_in_local.transform_points(maps.plan_in(room))
    return scene_of(context, Plan(path_xy, 6.0), use_global_costmap), near.window


def cost_to_go(room, global_costmap, map_in_local, from_xy=START_XY):
    """Cost to go from a position [m]."""
    scene, window = scene_in(room, global_costmap, map_in_local)
    return scene.to_go[window.cell_of(*map_in_local.transform_points(np.array([from_xy]))[0])]


def without_walls(room):
    """The costmap of the room without its walls."""
    grid = OccupancyGrid(np.zeros(room.costmap.costs.shape, np.int8), 0.05, Pose2())
    return LayeredCostmap(room.costmap.settings, grid)


@pytest.mark.parametrize("map_in_local", [Pose2(), TURNED])
def test_the_cost_to_go_leads_around_a_wall_of_the_global_costmap(walled, map_in_local):
    assert cost_to_go(walled, without_walls(walled), map_in_local) == pytest.approx(4.5, rel=0.05)
    assert cost_to_go(walled, walled.costmap, map_in_local) > 5.8


@pytest.mark.parametrize("map_in_local", [Pose2(), TURNED])
def test_the_clearance_includes_a_wall_of_the_global_costmap(walled, map_in_local):
    scene, window = scene_in(walled, walled.costmap, map_in_local)
    beside = window.cell_of(*map_in_local.transform_points(np.array([(2.5, 2.0)]))[0])
    assert scene.clearance[beside] == pytest.approx(0.5, abs=0.08)


def test_by_default_only_the_local_costmap_counts(walled):
    scene, _ = scene_in(walled, walled.costmap, Pose2(), use_global_costmap=False)
    bare, _ = scene_in(walled, without_walls(walled), Pose2(), use_global_costmap=False)
    np.testing.assert_array_equal(scene.clearance, bare.clearance)
    np.testing.assert_array_equal(scene.to_go, bare.to_go)


def test_cells_beside_a_wall_of_the_global_costmap_are_expensive(walled):
    settings = walled.costmap.settings
    bare = walled.costmap.with_settings(with_layer(settings, "inflation", enabled=False))
    past_corner_xy = (3.25, 0.9)
    lethal_alone = cost_to_go(walled, bare, Pose2(), past_corner_xy)
    assert cost_to_go(walled, walled.costmap, Pose2(), past_corner_xy) > lethal_alone + 0.3


@pytest.mark.parametrize("map_in_local", [Pose2(), TURNED])
def test_a_path_leads_out_of_the_inscribed_cells_of_the_global_costmap(walled, map_in_local):
    beside_wall_xy = (2.875, 2.75)
    assert walled.costmap.costs[walled.costmap.window.cell_of(*beside_wall_xy)] == INSCRIBED
    free = cost_to_go(walled, without_walls(walled), map_in_local, beside_wall_xy)
    known = cost_to_go(walled, walled.costmap, map_in_local, beside_wall_xy)
    assert free + 0.3 < known < np.inf
