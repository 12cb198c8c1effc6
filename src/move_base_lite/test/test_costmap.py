"""Costmaps: what scans mark and clear, how far obstacles reach."""

import math

import numpy as np
import pytest

from move_base_lite.costmap import (
    FREE,
    INSCRIBED,
    LETHAL,
    UNKNOWN,
    CostmapSettings,
    LayeredCostmap,
    occupancy_of,
)
from move_base_lite.costmap.inflation import InflationSettings
from move_base_lite.costmap.obstacle_layer import ObstacleSettings
from move_base_lite.costmap.static_layer import StaticSettings
from planar import OccupancyGrid, Pose2, Scan, SettingsError, grid_from_picture

INFLATION = InflationSettings(inflation_radius=0.5, cost_scaling_factor=5.0)
OBSTACLES = ObstacleSettings(clearing=True, inf_is_valid=True)
ROLLING = CostmapSettings(
    rolling_window=True, width=4.0, height=4.0, robot_radius=0.2, obstacles=OBSTACLES, inflation=INFLATION
)


def scan_of(*ranges, angle_min=0.0, angle_increment=0.1):
    return Scan(0.0, angle_min, angle_increment, np.array(ranges, dtype=np.float32), 0.1, 10.0)


def cost_at(costmap, x, y):
    return costmap.costs[costmap.window.cell_of(x, y)]


def test_costs_fall_with_distance_as_costmap_2d_computes_them():
    costmap = LayeredCostmap(ROLLING)
    costmap.update(Pose2(), scan_of(1.025))
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


def test_a_beam_that_passes_where_an_obstacle_was_clears_it():
    costmap = LayeredCostmap(ROLLING)
    costmap.update(Pose2(), scan_of(1.025))
    assert cost_at(costmap, 1.025, 0.01) == LETHAL
    costmap.update(Pose2(), scan_of(1.525))
    assert cost_at(costmap, 1.025, 0.01) < INSCRIBED
    assert cost_at(costmap, 1.525, 0.01) == LETHAL


@pytest.mark.parametrize(
    "no_return, inf_is_valid, is_cleared",
    [(np.inf, True, True), (np.inf, False, False), (np.nan, True, False), (-np.inf, True, False)],
)
def test_a_beam_without_return_clears_only_as_valid_infinity(no_return, inf_is_valid, is_cleared):
    obstacles = ObstacleSettings(clearing=True, inf_is_valid=inf_is_valid)
    costmap = LayeredCostmap(CostmapSettings(rolling_window=True, width=4.0, height=4.0, obstacles=obstacles))
    costmap.update(Pose2(), scan_of(1.025))
    costmap.update(Pose2(), scan_of(no_return))
    assert (cost_at(costmap, 1.025, 0.01) != LETHAL) == is_cleared


def test_what_lies_beyond_obstacle_range_is_not_marked():
    costmap = LayeredCostmap(CostmapSettings(rolling_window=True, width=8.0, height=8.0, obstacles=OBSTACLES))
    costmap.update(Pose2(), scan_of(2.6))
    assert not (costmap.costs == LETHAL).any()


def test_a_laser_mounted_upside_down_marks_on_the_other_side():
    scan = scan_of(1.0, angle_min=math.pi / 2)
    costmap = LayeredCostmap(ROLLING)
    costmap.update(Pose2(), Scan(**{**vars(scan), "upside_down": True}))
    assert cost_at(costmap, 0.01, -0.99) == LETHAL


def test_a_rolling_window_keeps_what_stays_in_it_where_it_was():
    costmap = LayeredCostmap(ROLLING)
    costmap.update(Pose2(), scan_of(1.025))
    costmap.update(Pose2(0.33, 0.71), None)
    assert cost_at(costmap, 1.025, 0.01) == LETHAL
    assert np.count_nonzero(costmap.costs == LETHAL) == 1
    costmap.update(Pose2(5.0, 0.0), None)
    assert not costmap.costs.any()


def test_updating_what_a_scan_touches_equals_computing_everything():
    rng = np.random.default_rng(1)
    grid = OccupancyGrid((100 * (rng.random((120, 120)) < 0.01)).astype(np.int8), 0.05)
    settings = CostmapSettings(
        static=StaticSettings(), robot_radius=0.2, obstacles=OBSTACLES, inflation=INFLATION
    )
    costmap = LayeredCostmap(settings, grid)
    for _ in range(5):
        base = Pose2(*rng.uniform(1.0, 5.0, 2), rng.uniform(-3.0, 3.0))
        ranges = np.where(rng.random(90) < 0.2, np.inf, rng.uniform(0.2, 5.0, 90))
        costmap.update(base, scan_of(*ranges, angle_increment=2 * math.pi / 90))
        part_by_part = costmap.costs.copy()
        costmap.refresh(costmap.window.everything)
        np.testing.assert_array_equal(part_by_part, costmap.costs)


def test_the_map_stays_when_obstacles_are_forgotten():
    grid = grid_from_picture("#....\n.....\n.....", 1.0)
    settings = CostmapSettings(static=StaticSettings(), robot_radius=0.2, obstacles=OBSTACLES)
    costmap = LayeredCostmap(settings, grid)
    costmap.update(Pose2(0.5, 0.5), scan_of(2.0))
    assert cost_at(costmap, 2.5, 0.5) == LETHAL
    costmap.reset()
    assert cost_at(costmap, 2.5, 0.5) == FREE
    assert cost_at(costmap, 0.5, 2.5) == LETHAL


def test_clearing_outside_a_square_keeps_what_is_near():
    costmap = LayeredCostmap(ROLLING)
    costmap.update(Pose2(), scan_of(0.6, 1.8, angle_increment=math.pi / 2))
    costmap.clear_outside(Pose2(), side=2.0)
    assert cost_at(costmap, 0.61, 0.01) == LETHAL
    assert cost_at(costmap, 0.01, 1.81) == FREE


def test_nothing_is_marked_where_the_robot_stands():
    costmap = LayeredCostmap(ROLLING)
    costmap.update(Pose2(), scan_of(0.15))
    assert not costmap.collides(Pose2())


def test_unknown_cells_stay_unknown_until_seen():
    grid = grid_from_picture("?????\n.....\n.....", 1.0)
    settings = CostmapSettings(static=StaticSettings(), track_unknown_space=True, obstacles=OBSTACLES)
    costmap = LayeredCostmap(settings, grid)
    assert cost_at(costmap, 1.5, 2.5) == UNKNOWN
    costmap.update(Pose2(0.5, 2.5), scan_of(np.inf))
    assert cost_at(costmap, 1.5, 2.5) == FREE
    assert cost_at(costmap, 4.5, 2.5) == UNKNOWN


@pytest.mark.parametrize("name", ["circle", "rectangle"])
def test_the_exact_footprint_decides_about_a_collision(name):
    corners = {"circle": (), "rectangle": ((-0.3, -0.1), (-0.3, 0.1), (0.3, 0.1), (0.3, -0.1))}[name]
    settings = CostmapSettings(
        rolling_window=True, width=4.0, height=4.0, footprint=corners, robot_radius=0.2, footprint_padding=0.0
    )
    costmap = LayeredCostmap(settings)
    costmap.update(Pose2(1.0, 0.0), scan_of(0.525))
    assert costmap.collides(Pose2(1.24, 0.0)) == (name == "rectangle")
    assert not costmap.collides(Pose2(1.24, 0.0, math.pi / 2))
    assert costmap.collides(Pose2(1.49, 0.0, math.pi / 2))
    assert costmap.collides(Pose2(9.0, 0.0))


def test_rviz_sees_costs_on_a_scale_to_100():
    costs = np.array([0, 1, 252, 253, 254, 255], dtype=np.uint8)
    assert occupancy_of(costs).tolist() == [0, 1, 98, 99, 100, -1]


def test_marks_that_could_never_be_cleared_are_refused():
    with pytest.raises(SettingsError, match="raytrace_range must be at least obstacle_range"):
        ObstacleSettings(clearing=True, obstacle_range=3.0, raytrace_range=2.5)
