"""Localization among people who shorten every second beam."""

import numpy as np

from amcl_lite import Localizer, LocalizerSettings
from planar import Pose2, Scan, grid_from_picture
from planar.geometry.ray_casting import cast_rays

ROOM = """
##############
#......#.....#
#......#.....#
#............#
#......#.....#
####...#######
#............#
##############
"""
NAME = "plugin_examples.short_readings/ShortReadings"
ANGLES = np.linspace(-np.pi, np.pi, 180, endpoint=False)
RANGE_MAX, CUT = 8.0, 0.5
START, STEP = Pose2(1.0, 2.4, 0.0), Pose2(0.1, 0.0, 0.02)


def room():
    return grid_from_picture(ROOM, 0.05, scale=10)


def scan_at(grid, base, stamp, rng):
    ranges = np.minimum(
        cast_rays(grid, base, ANGLES, RANGE_MAX) + rng.normal(0.0, 0.01, len(ANGLES)), RANGE_MAX
    )
    is_cut = rng.random(len(ANGLES)) < CUT
    ranges[is_cut] *= rng.uniform(0.3, 0.95, is_cut.sum())
    return Scan(stamp, ANGLES[0], ANGLES[1] - ANGLES[0], ranges.astype(np.float32), 0.05, RANGE_MAX)


def error_of(seed):
    grid, rng = room(), np.random.default_rng(seed)
    settings = LocalizerSettings(
        sensor_plugin=NAME, beams=60, max_particles=1000, update_min_distance=0.05, refine_pose=False
    )
    localizer = Localizer(grid, settings, np.random.default_rng(seed))
    localizer.set_pose(START @ Pose2(0.15, -0.1, 0.1), np.diag([0.04, 0.04, 0.02]))
    true = START
    for number in range(20):
        localizer.update(START.inverse() @ true, scan_at(grid, true, 0.1 * number, rng))
        true = true @ STEP
    estimate = localizer.odom_in_map @ (START.inverse() @ true)
    return estimate.distance_to(true)


def test_a_robot_among_people_is_localized():
    errors = [error_of(seed) for seed in range(5)]
    assert np.median(errors) < 0.06 and max(errors) < 0.15, errors
