"""Costs follow a walking person, reach farther ahead than behind, and vanish when nobody walks."""

import numpy as np
import pytest

from move_base_lite.costmap import (
    CostmapPlacement,
    CostmapWindow,
    LayerContext,
    footprint_from,
    observation_from_scan,
)
from planar import Pose2, Scan
from plugin_examples.social_distance import SocialDistance, SocialDistanceSettings

WINDOW = CostmapWindow(80, 80, 0.1, -4.0, -4.0)
SPEED, START, RADIUS, WALL = 0.8, -1.6, 0.2, 3.8
ANGLES = np.linspace(-np.pi, np.pi, 360, endpoint=False)


def scan_of(stamp, walks=True):
    """A round room in which a person walks past, 1.5 m to the left of the robot."""
    x, y = (START + SPEED * stamp, 1.5) if walks else (START, 1.5)
    along = x * np.cos(ANGLES) + y * np.sin(ANGLES)
    aside = y * np.cos(ANGLES) - x * np.sin(ANGLES)
    with np.errstate(invalid="ignore"):
        near = along - np.sqrt(RADIUS**2 - aside**2)
    ranges = np.where((np.abs(aside) < RADIUS) & (along > 0.0), near, WALL)
    return Scan(stamp, ANGLES[0], ANGLES[1] - ANGLES[0], ranges, 0.05, 5.0)


def costs_after(seconds, walks=True):
    layer = SocialDistance(SocialDistanceSettings(), LayerContext(WINDOW, True, footprint_from((), 0.2, 0.0)))
    costs = np.zeros((WINDOW.rows, WINDOW.cols), np.uint8)
    for number in range(round(10 * seconds)):
        layer.add_observation(observation_from_scan("scan", scan_of(0.1 * number, walks)), Pose2())
        bounds = layer.update(CostmapPlacement(WINDOW, 0, 0, Pose2(), Pose2()))
        costs[bounds.slices] = 0
        layer.apply(costs, WINDOW, bounds)
    return costs


def cost_at(costs, x, y):
    return int(costs[WINDOW.cell_of(x, y)])


def test_a_walking_person_has_more_clearance_ahead_than_behind():
    costs = costs_after(2.5)
    x = START + SPEED * 2.4
    assert cost_at(costs, x, 1.5) > 200
    assert cost_at(costs, x + 1.0, 1.5) > 80 > 25 > cost_at(costs, x - 1.0, 1.5)
    assert costs.max() < 253, "expensive, not lethal"


def test_the_costs_follow_the_person_and_leave_no_trace():
    costs = costs_after(3.5)
    assert cost_at(costs, START + 0.2, 1.5) == 0
    assert cost_at(costs, START + SPEED * 3.4, 1.5) > 200


def test_a_standing_person_costs_nothing():
    assert costs_after(2.5, walks=False).max() == 0


@pytest.mark.parametrize("topic", ["scan", "other"])
def test_only_its_own_laser_counts(topic):
    layer = SocialDistance(
        SocialDistanceSettings(topic=topic), LayerContext(WINDOW, True, footprint_from((), 0.2, 0.0))
    )
    for number in range(25):
        layer.add_observation(observation_from_scan("scan", scan_of(0.1 * number)), Pose2())
    bounds = layer.update(CostmapPlacement(WINDOW, 0, 0, Pose2(), Pose2()))
    assert (bounds.row_max > bounds.row_min) is (topic == "scan")
