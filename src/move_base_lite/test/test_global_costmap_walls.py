"""What leads to the goal, where the plan knows of walls that the costmap around the robot does not show."""

from dataclasses import replace

import numpy as np
import pytest

from move_base_lite.check import maps
from move_base_lite.control import Plan
from move_base_lite.control.mppi.scene import scene_of
from move_base_lite.costmap import INSCRIBED, CostmapSettings, LayeredCostmap
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
    """At the start, driving on a costmap in which there is nothing; and that costmap's window."""
    nothing = OccupancyGrid(np.zeros((400, 400), np.int8), 0.05, Pose2(-10.0, -10.0, 0.0))
    near = LayeredCostmap(CostmapSettings(static=StaticSettings(), robot_radius=maps.RADIUS), nothing)
    base = Pose2(*room.start_xy, 0.0)
    context = replace(
        maps.context_of(near, map_in_local @ base), base_in_map=base, global_costmap=global_costmap
    )
    path_xy = map_in_local.transform_points(maps.plan_in(room))
    return scene_of(context, Plan(path_xy, 6.0), use_global_costmap), near.window


def metres_to_go(room, global_costmap, map_in_local, from_xy=START_XY):
    """To the goal."""
    scene, window = scene_in(room, global_costmap, map_in_local)
    return scene.to_go[window.cell_of(*map_in_local.transform_points(np.array([from_xy]))[0])]


def nothing_known(room):
    """The costmap of the room without its walls."""
    grid = OccupancyGrid(np.zeros(room.costmap.costs.shape, np.int8), 0.05, Pose2())
    return LayeredCostmap(room.costmap.settings, grid)


@pytest.mark.parametrize("map_in_local", [Pose2(), TURNED])
def test_nothing_leads_through_a_wall_that_only_the_plan_knows(walled, map_in_local):
    assert metres_to_go(walled, nothing_known(walled), map_in_local) == pytest.approx(4.5, rel=0.05)
    assert metres_to_go(walled, walled.costmap, map_in_local) > 5.8


@pytest.mark.parametrize("map_in_local", [Pose2(), TURNED])
def test_nothing_comes_near_to_a_wall_that_only_the_plan_knows(walled, map_in_local):
    scene, window = scene_in(walled, walled.costmap, map_in_local)
    beside = window.cell_of(*map_in_local.transform_points(np.array([(2.5, 2.0)]))[0])
    assert scene.clearance[beside] == pytest.approx(0.5, abs=0.08)


def test_unless_asked_to_a_robot_goes_by_what_its_sensors_see(walled):
    scene, _ = scene_in(walled, walled.costmap, Pose2(), use_global_costmap=False)
    bare, _ = scene_in(walled, nothing_known(walled), Pose2(), use_global_costmap=False)
    np.testing.assert_array_equal(scene.clearance, bare.clearance)
    np.testing.assert_array_equal(scene.to_go, bare.to_go)


def test_it_is_dear_close_to_a_wall_that_only_the_plan_knows(walled):
    settings = walled.costmap.settings
    bare = walled.costmap.with_settings(
        replace(settings, inflation=replace(settings.inflation, enabled=False))
    )
    past_corner_xy = (3.25, 0.9)
    lethal_alone = metres_to_go(walled, bare, Pose2(), past_corner_xy)
    assert metres_to_go(walled, walled.costmap, Pose2(), past_corner_xy) > lethal_alone + 0.3


@pytest.mark.parametrize("map_in_local", [Pose2(), TURNED])
def test_a_way_leads_out_of_what_is_too_near_to_a_wall_that_only_the_plan_knows(walled, map_in_local):
    beside_wall_xy = (2.875, 2.75)
    assert walled.costmap.costs[walled.costmap.window.cell_of(*beside_wall_xy)] == INSCRIBED
    free = metres_to_go(walled, nothing_known(walled), map_in_local, beside_wall_xy)
    known = metres_to_go(walled, walled.costmap, map_in_local, beside_wall_xy)
    assert free + 0.3 < known < np.inf
