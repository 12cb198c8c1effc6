"""Headings of plans in global_planner's orientation modes."""

import math

import numpy as np
import pytest

from move_base_lite.planning import headings_along
from planar import wrap

# East, then north.
BENT_XY = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0]])
NORTH = math.pi / 2


@pytest.mark.parametrize(
    "mode, expected",
    [
        (0, [0.0, 0.0, 0.0, 0.0]),
        (1, [0.0, 0.0, NORTH, NORTH]),
        (2, [0.4, 0.3, 0.2, 0.1]),
        (3, [0.0, 0.0, NORTH, NORTH / 2]),
        (4, [math.pi, math.pi, -NORTH, -NORTH]),
        (5, [NORTH, NORTH, math.pi, math.pi]),
        (6, [-NORTH, -NORTH, 0.0, 0.0]),
    ],
)
def test_each_mode_orients_the_path_and_ends_with_the_goal_heading(mode, expected):
    yaws = headings_along(BENT_XY, mode, start_yaw=0.4, goal_yaw=0.0)
    assert np.abs(wrap(yaws - np.array([*expected, 0.0]))).max() < 1e-9


def test_an_empty_path_has_no_headings():
    assert len(headings_along(np.empty((0, 2)), 1, 0.0, 1.0)) == 0
