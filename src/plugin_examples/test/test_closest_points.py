"""ICP tracks a drive through rooms with biased odometry."""

import numpy as np
import pytest

from planar import Pose2, Scan, grid_from_picture
from planar.geometry.ray_casting import cast_rays
from slam_lite.config import MapperSettings
from slam_lite.mapper import Mapper

ROOM = """
##############
#......#.....#
#............#
#......#..#..#
#..#.........#
##############
"""
ANGLES = np.linspace(-np.pi, np.pi, 240, endpoint=False)
RANGE_MAX = 8.0
START, STEP = Pose2(1.0, 1.75), Pose2(0.08, 0.0, 0.0)


def errors_of(seed, matcher):
    """Position errors of odometry and of the mapper after a drive of 60 scans [m]."""
    grid = grid_from_picture(ROOM, 0.05, scale=10)
    rng = np.random.default_rng(seed)
    mapper, true, odometry = Mapper(MapperSettings(matcher_plugin=matcher)), START, START
    for number in range(60):
        ranges = cast_rays(grid, true, ANGLES, RANGE_MAX) + rng.normal(0.0, 0.01, len(ANGLES))
        scan = Scan(
            0.2 * number, ANGLES[0], ANGLES[1] - ANGLES[0], ranges.astype(np.float32), 0.05, RANGE_MAX
        )
        update = mapper.insert(odometry, scan)
        last = true
        true = true @ STEP
        odometry = odometry @ Pose2(STEP.x * 1.05, 0.0, STEP.yaw + 0.01)
    return odometry.distance_to(true), update.base_in_map.distance_to(last)


@pytest.mark.parametrize("seed", range(3))
def test_a_drive_is_tracked_within_centimetres_with_odometry_errors_of_decimetres(seed):
    off, error = errors_of(seed, "plugin_examples.closest_points/ClosestPoints")
    assert off > 0.5
    assert error < 0.08
