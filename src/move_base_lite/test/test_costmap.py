"""Costmaps: marking, clearing and inflation."""

import math
from dataclasses import replace

import numpy as np
import pytest
from costmap_with_layers import costmap_with, with_layer

from move_base_lite.costmap import (
    FREE,
    INSCRIBED,
    LETHAL,
    UNKNOWN,
    LayeredCostmap,
    observation_from_points,
    observation_from_scan,
    occupancy_of,
)
from move_base_lite.costmap.layers.inflation import InflationSettings
from move_base_lite.costmap.layers.obstacles import ObstacleSettings, SourceSettings
from move_base_lite.costmap.layers.static import StaticSettings
from planar import OccupancyGrid, Pose2, Scan, SettingsError, grid_from_picture

INFLATION = InflationSettings(inflation_radius=0.5, cost_scaling_factor=5.0)


def laser(**values):
    """An obstacle layer with one laser."""
    source = {"topic": "scan", "data_type": "LaserScan", "clearing": True, "inf_is_valid": True}
    return ObstacleSettings(sources=(SourceSettings(**{**source, **values}),))


OBSTACLES = laser()


def rolling(obstacles, static=None):
    """A costmap that follows the robot."""
    return costmap_with(
        static, obstacles, INFLATION, rolling_window=True, width=4.0, height=4.0, robot_radius=0.2
    )


ROLLING = rolling(OBSTACLES)


def scan_of(*ranges, angle_min=0.0, angle_increment=0.1):
    return Scan(0.0, angle_min, angle_increment, np.array(ranges, dtype=np.float32), 0.1, 10.0)


def integrate(costmap, base, scan):
    """Update with a scan taken at a pose."""
    costmap.add_observation(observation_from_scan("scan", scan), base)
    costmap.update(base)


def cost_at(costmap, x, y):
    return costmap.costs[costmap.window.cell_of(x, y)]


def test_costs_fall_with_distance_as_costmap_2d_computes_them():
    costmap = LayeredCostmap(ROLLING)
    integrate(costmap, Pose2(), scan_of(1.025))
    inscribed = costmap.footprint.inscribed_radius
    for cells in range(11):
        distance = cells * 0.05
        expected = math.floor(252 * math.exp(-5.0 * (distance - inscribed)))
        if cells == 0:
            expected = LETHAL
        elif distance <= inscribed:
            expected = INSCRIBED
        assert cost_at(costmap, 1.025, distance + 0.01) == expected
    assert cost_at(costmap, 1.025, 0.56) == FREE


def test_a_beam_through_an_obstacle_clears_it():
    costmap = LayeredCostmap(ROLLING)
    integrate(costmap, Pose2(), scan_of(1.025))
    assert cost_at(costmap, 1.025, 0.01) == LETHAL
    integrate(costmap, Pose2(), scan_of(1.525))
    assert cost_at(costmap, 1.025, 0.01) < INSCRIBED
    assert cost_at(costmap, 1.525, 0.01) == LETHAL


@pytest.mark.parametrize(
    "no_return, inf_is_valid, is_cleared",
    [(np.inf, True, True), (np.inf, False, False), (np.nan, True, False), (-np.inf, True, False)],
)
def test_a_beam_without_return_clears_only_as_valid_infinity(no_return, inf_is_valid, is_cleared):
    obstacles = laser(inf_is_valid=inf_is_valid)
    costmap = LayeredCostmap(costmap_with(rolling_window=True, width=4.0, height=4.0, obstacles=obstacles))
    integrate(costmap, Pose2(), scan_of(1.025))
    integrate(costmap, Pose2(), scan_of(no_return))
    assert (cost_at(costmap, 1.025, 0.01) != LETHAL) == is_cleared


def test_returns_beyond_obstacle_range_are_not_marked():
    costmap = LayeredCostmap(costmap_with(rolling_window=True, width=8.0, height=8.0, obstacles=OBSTACLES))
    integrate(costmap, Pose2(), scan_of(2.6))
    assert not (costmap.costs == LETHAL).any()


def test_a_laser_mounted_upside_down_marks_on_the_other_side():
    scan = scan_of(1.0, angle_min=math.pi / 2)
    costmap = LayeredCostmap(ROLLING)
    integrate(costmap, Pose2(), Scan(**{**vars(scan), "upside_down": True}))
    assert cost_at(costmap, 0.01, -0.99) == LETHAL


def test_a_rolling_window_keeps_obstacles_at_their_place():
    costmap = LayeredCostmap(ROLLING)
    integrate(costmap, Pose2(0.0, 0.01), scan_of(1.025))
    costmap.update(Pose2(0.33, 0.71))
    assert cost_at(costmap, 1.025, 0.01) == LETHAL
    assert np.count_nonzero(costmap.costs == LETHAL) == 1
    costmap.update(Pose2(5.0, 0.0))
    assert not costmap.costs.any()


def test_an_update_of_the_observed_block_equals_a_full_computation():
    rng = np.random.default_rng(1)
    grid = OccupancyGrid((100 * (rng.random((120, 120)) < 0.01)).astype(np.int8), 0.05)
    settings = costmap_with(
        static=StaticSettings(), robot_radius=0.2, obstacles=OBSTACLES, inflation=INFLATION
    )
    costmap = LayeredCostmap(settings, grid)
    for _ in range(5):
        base = Pose2(*rng.uniform(1.0, 5.0, 2), rng.uniform(-3.0, 3.0))
        ranges = np.where(rng.random(90) < 0.2, np.inf, rng.uniform(0.2, 5.0, 90))
        integrate(costmap, base, scan_of(*ranges, angle_increment=2 * math.pi / 90))
        incremental = costmap.costs.copy()
        costmap.recompute(costmap.window.everything)
        np.testing.assert_array_equal(incremental, costmap.costs)


def test_the_map_stays_when_obstacles_are_cleared():
    grid = grid_from_picture("#....\n.....\n.....", 1.0)
    settings = costmap_with(static=StaticSettings(), robot_radius=0.2, obstacles=OBSTACLES)
    costmap = LayeredCostmap(settings, grid)
    integrate(costmap, Pose2(0.5, 0.5), scan_of(2.0))
    assert cost_at(costmap, 2.5, 0.5) == LETHAL
    costmap.reset()
    assert cost_at(costmap, 2.5, 0.5) == FREE
    assert cost_at(costmap, 0.5, 2.5) == LETHAL


def test_a_costmap_keeps_the_size_of_a_map_that_is_switched_off_and_on():
    grid = grid_from_picture("#....\n.....\n.....", 1.0)
    settings = costmap_with(static=StaticSettings(), robot_radius=0.2, obstacles=OBSTACLES)
    costmap = LayeredCostmap(settings, grid)
    integrate(costmap, Pose2(0.5, 0.5), scan_of(2.0))
    without_map = costmap.with_settings(with_layer(settings, "static", enabled=False))
    without_map = without_map.with_settings(replace(without_map.settings, height=7.0))
    assert without_map.window == costmap.window
    assert (cost_at(without_map, 2.5, 0.5), cost_at(without_map, 0.5, 2.5)) == (LETHAL, FREE)
    np.testing.assert_array_equal(without_map.with_settings(settings).costs, costmap.costs)


def test_clearing_outside_a_square_keeps_obstacles_inside():
    costmap = LayeredCostmap(ROLLING)
    integrate(costmap, Pose2(), scan_of(0.6, 1.8, angle_increment=math.pi / 2))
    costmap.clear_outside(Pose2(), side=2.0)
    assert cost_at(costmap, 0.61, 0.01) == LETHAL
    assert cost_at(costmap, 0.01, 1.81) == FREE


def test_cells_of_the_footprint_are_not_marked():
    costmap = LayeredCostmap(ROLLING)
    integrate(costmap, Pose2(), scan_of(0.15))
    assert not costmap.collides(Pose2())


def test_unknown_cells_stay_unknown_until_observed():
    grid = grid_from_picture("?????\n.....\n.....", 1.0)
    obstacles = replace(OBSTACLES, track_unknown_space=True)
    settings = costmap_with(static=StaticSettings(), track_unknown_space=True, obstacles=obstacles)
    costmap = LayeredCostmap(settings, grid)
    assert cost_at(costmap, 1.5, 2.5) == UNKNOWN
    integrate(costmap, Pose2(0.5, 2.5), scan_of(np.inf))
    assert cost_at(costmap, 1.5, 2.5) == FREE
    assert cost_at(costmap, 4.5, 2.5) == UNKNOWN


@pytest.mark.parametrize("name", ["circle", "rectangle"])
def test_the_exact_footprint_decides_about_a_collision(name):
    corners = {"circle": (), "rectangle": ((-0.3, -0.1), (-0.3, 0.1), (0.3, 0.1), (0.3, -0.1))}[name]
    settings = replace(ROLLING, footprint=corners, footprint_padding=0.0)
    costmap = LayeredCostmap(settings)
    integrate(costmap, Pose2(1.0, 0.0), scan_of(0.525))
    assert costmap.collides(Pose2(1.24, 0.0)) == (name == "rectangle")
    assert not costmap.collides(Pose2(1.24, 0.0, math.pi / 2))
    assert costmap.collides(Pose2(1.49, 0.0, math.pi / 2))
    assert costmap.collides(Pose2(9.0, 0.0))


def test_costs_for_rviz_range_to_100():
    costs = np.array([0, 1, 252, 253, 254, 255], dtype=np.uint8)
    assert occupancy_of(costs).tolist() == [0, 1, 98, 99, 100, -1]


def test_settings_with_marks_that_are_never_cleared_are_refused():
    with pytest.raises(SettingsError, match="raytrace_range must be at least obstacle_range"):
        laser(obstacle_range=3.0, raytrace_range=2.5)


def test_each_sensor_marks_points_within_its_heights():
    sources = (
        SourceSettings(topic="low", data_type="PointCloud2", max_obstacle_height=0.3),
        SourceSettings(topic="high", data_type="PointCloud2", min_obstacle_height=0.25),
    )
    costmap = LayeredCostmap(with_layer(ROLLING, "obstacles", sources=sources))
    points_xyz = np.array([[1.0, 0.0, 0.1], [1.0, 0.5, 1.0], [1.0, -0.5, 2.5], [1.0, -1.0, np.nan]])
    for topic, marked in [("unknown", []), ("low", [0]), ("high", [0, 1])]:
        costmap.add_observation(
            observation_from_points(topic, 0.0, Pose2(0.1, 0.2, 0.3), points_xyz), Pose2()
        )
        costmap.update(Pose2())
        is_marked = [cost_at(costmap, x, y) == LETHAL for x, y, _ in points_xyz]
        assert np.flatnonzero(is_marked).tolist() == marked


def test_a_scan_outside_the_heights_of_its_source_is_ignored():
    costmap = LayeredCostmap(rolling(laser(min_obstacle_height=0.25)))
    costmap.add_observation(observation_from_scan("scan", scan_of(1.0), height=0.1), Pose2())
    costmap.update(Pose2())
    assert not costmap.costs.any()


def test_marks_persist_for_observation_persistence():
    costmap = LayeredCostmap(rolling(laser(observation_persistence=1.0)))
    for stamp, is_marked in [(0.0, True), (0.9, True), (1.8, False)]:
        scan = replace(scan_of(1.025 if stamp == 0.0 else 1.525), stamp=stamp)
        integrate(costmap, Pose2(), scan)
        assert (cost_at(costmap, 1.025, 0.01) == LETHAL) == is_marked


@pytest.mark.parametrize("method, expected", [(0, FREE), (1, LETHAL), (99, LETHAL)])
def test_a_layer_overwrites_the_map_only_with_that_combination_method(method, expected):
    grid = grid_from_picture("#....\n.....\n.....", 1.0)
    obstacles = replace(OBSTACLES, combination_method=method)
    costmap = LayeredCostmap(costmap_with(static=StaticSettings(), obstacles=obstacles), grid)
    integrate(costmap, Pose2(0.5, 0.5), scan_of(2.0))
    assert cost_at(costmap, 0.5, 2.5) == expected
    assert (cost_at(costmap, 2.5, 0.5) == LETHAL) == (method != 99)


def test_a_rolling_window_contains_the_map_transformed_to_its_frame():
    grid = OccupancyGrid(np.zeros((100, 100), np.int8), 0.1, Pose2(-5.0, -5.0))
    grid.cells[60, 70] = 100
    costmap = LayeredCostmap(rolling(OBSTACLES, static=StaticSettings()), grid)
    map_in_odom = Pose2(0.3, -0.2, 0.7)
    block = map_in_odom @ Pose2(2.05, 1.05)
    costmap.update(map_in_odom @ Pose2(1.0, 1.0, 0.4), map_in_odom)
    assert cost_at(costmap, block.x, block.y) == LETHAL
    assert np.count_nonzero(costmap.costs == LETHAL) == pytest.approx(4, abs=2), "a cell of 0.1 m"


def test_only_the_changed_block_is_reported():
    costmap = LayeredCostmap(costmap_with(width=20.0, height=20.0, obstacles=OBSTACLES))
    assert costmap.pop_changed_bounds() == costmap.window.everything
    integrate(costmap, Pose2(10.0, 10.0), scan_of(1.0))
    block = costmap.pop_changed_bounds()
    assert (block.row_max - block.row_min) * 0.05 < 10.0
    assert cost_at(costmap, 11.01, 10.01) == LETHAL
    assert costmap.pop_changed_bounds() == (0, 0, 0, 0)
