import math

import numpy as np
import pytest

from planar import Pose2, Scan


def scan(ranges, **rest):
    return Scan(0.0, 0.0, math.pi / 2, np.array(ranges, np.float32), 0.1, 10.0, **rest)


def test_only_finite_ranges_within_limits_are_hits():
    assert scan([1.0, np.nan, np.inf, 0.05, 10.0]).hits.tolist() == [True, False, False, False, False]


def test_end_points_are_given_in_the_base_frame():
    points = scan([1.0, 2.0], laser_in_base=Pose2(0.5, 0.0, math.pi / 2)).hit_points_in_base()
    assert points == pytest.approx(np.array([[0.5, 1.0], [-1.5, 0.0]]), abs=1e-6)


def test_an_upside_down_laser_counts_its_angles_the_other_way():
    points = scan([1.0, 2.0], upside_down=True).hit_points_in_base()
    assert points == pytest.approx(np.array([[1.0, 0.0], [0.0, -2.0]]), abs=1e-6)
