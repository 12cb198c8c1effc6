"""Distance between a rectangular robot and a dynamic obstacle."""

import math

import numpy as np
import pytest

from move_base_lite.control.mppi.scene import MppiScene, dynamic_obstacle_clearance

RADIUS, HALF_LENGTH, HALF_WIDTH = 0.5, 0.22, 0.175
CIRCUMSCRIBED = math.hypot(HALF_LENGTH, HALF_WIDTH)


def clearance(x, y, yaw, half_length=HALF_LENGTH, half_width=HALF_WIDTH):
    """Clearance of a robot at the origin from an obstacle at x, y in its frame."""
    c, s = math.cos(yaw), math.sin(yaw)
    empty, obstacle = np.zeros((0, 0), np.float32), (c * x - s * y, s * x + c * y, 0.0, 0.0, RADIUS)
    scene = MppiScene(
        clearance=empty,
        to_go=empty,
        outline_xy=np.zeros((0, 2)),
        dynamic_obstacles=np.array([obstacle]),
        origin_x=0.0,
        origin_y=0.0,
        cells_per_metre=20.0,
        inscribed_radius=HALF_WIDTH,
        circumscribed_radius=CIRCUMSCRIBED,
        half_length=half_length,
        half_width=half_width,
    )
    return dynamic_obstacle_clearance(scene, 0.0, 0.0, c, s, 0.0, 2.0)


@pytest.mark.parametrize(
    "x, y, expected",
    [
        pytest.param(1.0, 0.0, 1.0 - HALF_LENGTH - RADIUS, id="ahead"),
        pytest.param(0.0, 1.0, 1.0 - HALF_WIDTH - RADIUS, id="aside"),
        pytest.param(1.0, 1.0, math.hypot(1.0 - HALF_LENGTH, 1.0 - HALF_WIDTH) - RADIUS, id="corner"),
    ],
)
@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.1])
def test_the_clearance_is_that_of_a_rectangular_robot(x, y, expected, yaw):
    assert clearance(x, y, yaw) == pytest.approx(expected)


def test_the_corners_of_the_box_around_a_round_robot_do_not_count():
    side = math.sqrt(0.5)
    round_robot = clearance(side, side, 0.0, CIRCUMSCRIBED, CIRCUMSCRIBED)
    assert round_robot == pytest.approx(1.0 - CIRCUMSCRIBED - RADIUS)
