"""The voxel layer keeps columns of voxels that move with the window and are cleared with the costs."""

import numpy as np
import pytest

from move_base_lite import settings_from_parameters
from move_base_lite.costmap import LayeredCostmap, observation_from_points
from move_base_lite.costmap.costs import FREE, LETHAL
from planar import Pose2, SettingsError

LOW, HIGH, BEYOND = [1.0, 0.0, 0.1], [1.0, 0.0, 1.0], [2.9, 0.0, 0.1]
START, SPOT = Pose2(), (1.02, 0.02)


def settings(**voxels):
    source = {"data_type": "PointCloud2", "clearing": True, "topic": "cloud"}
    layer = {"observation_sources": "cloud", "cloud": source, **voxels}
    plugins = [{"name": "voxels", "type": "costmap_2d::VoxelLayer"}]
    given = {"rolling_window": True, "width": 6.0, "height": 6.0, "resolution": 0.05, "robot_radius": 0.2}
    parameters = {"local_costmap": {**given, "plugins": plugins, "voxels": layer}}
    return settings_from_parameters(parameters)[0].local_costmap


def see(costmap, base, *points):
    """Update with a cloud; points are given in the costmap's frame."""
    points_xyz = np.array(points) - (base.x, base.y, 0.0)
    costmap.add_observation(observation_from_points("cloud", 1.0, Pose2(), points_xyz, 0.05), base)
    costmap.update(base)


def cost(costmap, place=SPOT):
    return int(costmap.costs[costmap.window.cell_of(*place)])


@pytest.fixture
def costmap():
    return LayeredCostmap(settings())


def test_voxels_keep_their_place_when_the_window_moves(costmap):
    see(costmap, START, LOW, HIGH)
    moved = Pose2(0.3, -0.2)
    see(costmap, moved, BEYOND)
    see(costmap, START, BEYOND)
    assert cost(costmap) == LETHAL, "the high voxel is still marked"
    see(costmap, START, [2.9, 0.0, 2.0], [2.9, 0.0, 3.0])
    see(costmap, START, [2.0, 0.0, 1.95])
    assert cost(costmap) == FREE, "a ray passed the high voxel"


def test_clearing_a_costmap_clears_voxels(costmap):
    see(costmap, START, LOW, HIGH)
    costmap.clear_around(START, 4.0)
    assert cost(costmap) == FREE
    see(costmap, START, LOW)
    see(costmap, START, BEYOND)
    assert cost(costmap) == FREE, "only the low voxel was marked"


def test_clearing_elsewhere_keeps_voxels(costmap):
    see(costmap, START, LOW, HIGH)
    costmap.clear_outside(START, 4.0)
    see(costmap, START, BEYOND)
    assert cost(costmap) == LETHAL


def test_another_threshold_keeps_the_voxels_and_other_heights_do_not(costmap):
    see(costmap, START, LOW, HIGH)
    assert cost(costmap.with_settings(settings(max_obstacle_height=1.5))) == LETHAL
    assert cost(costmap.with_settings(settings(z_resolution=0.1))) == FREE


def test_a_ray_straight_down_clears_its_column():
    costmap = LayeredCostmap(settings(observation_sources="cloud"))
    see(costmap, START, LOW)
    points = np.array([[1.0, 0.0, 0.0]])
    above = observation_from_points("cloud", 2.0, Pose2(1.0, 0.0), points, 1.5)
    costmap.add_observation(above, START)
    costmap.update(START)
    assert cost(costmap) == LETHAL, "the ray ends two cells above the floor, and its end is marked"


@pytest.mark.parametrize("name, value", [("z_voxels", 17), ("z_resolution", 0.0), ("mark_threshold", -1)])
def test_impossible_voxels_are_refused(name, value):
    with pytest.raises(SettingsError, match=f"voxels/{name} must be"):
        settings(**{name: value})
