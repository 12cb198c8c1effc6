"""Outdoors, where walls are farther off than the fine grid reaches."""

import math

import numpy as np
import pytest

from planar import Pose2, Scan, wrap
from slam_lite.config import MapperSettings
from slam_lite.mapper import Mapper
from slam_lite.matching.correlative import Window, search_far, search_near
from slam_lite.matching.local_map import wide_map
from slam_lite.matching.refinement import refine
from slam_lite.surface import Surface, filled, surface_of

BEAMS = 180
ANGLES = np.linspace(-math.pi / 2.0, math.pi / 2.0, BEAMS)
NO_BELIEF = np.zeros((3, 3))
# Corners (x0, y0), (x1, y1) of walls far from the origin, all in its sight.
WALLS = np.array([[60.0, -30.0, 52.0, 25.0], [40.0, -45.0, 60.0, -30.0], [10.0, 48.0, 52.0, 25.0]])


def ranges_from(pose, walls=WALLS, nothing=80.0):
    """How far it is to the nearest of some walls along each beam, (BEAMS,), without noise."""
    ranges = np.full(BEAMS, nothing)
    for x0, y0, x1, y1 in walls:
        dx, dy = x1 - x0, y1 - y0
        ahead, left = np.cos(pose.yaw + ANGLES), np.sin(pose.yaw + ANGLES)
        across = ahead * dy - left * dx
        far = ((x0 - pose.x) * dy - (y0 - pose.y) * dx) / across
        share = ((x0 - pose.x) * left - (y0 - pose.y) * ahead) / across
        hit = (far > 0.0) & (share >= 0.0) & (share <= 1.0)
        ranges[hit] = np.minimum(ranges[hit], far[hit])
    return ranges


def scan_from(pose, stamp=0.0, noise=0.0):
    ranges = ranges_from(pose) + noise
    return Scan(stamp, ANGLES[0], ANGLES[1] - ANGLES[0], ranges.astype(np.float32), 0.1, 80.0)


def surface_from(pose):
    return surface_of(scan_from(pose), 79.9, 0.03)


def map_from(pose):
    local_map = wide_map()
    local_map.clear(pose)
    local_map.add(surface_from(pose), pose)
    return local_map


def error(one, other):
    return one.distance_to(other), abs(wrap(one.yaw - other.yaw))


def test_a_step_is_seen_by_walls_fifty_metres_away():
    there = Pose2(0.35, 0.02, 0.03)
    local_map, guess = map_from(Pose2()), Pose2(0.15, 0.1, 0.06)
    start = search_near(surface_from(there), local_map, guess, Window(0.4, 0.1), np.full(3, 0.04))
    match = refine(surface_from(there), local_map, start, start, NO_BELIEF)
    distance, angle = error(match.base_pose, there)
    assert distance < 0.05 and angle < 0.001
    assert match.response > 0.9


def test_the_gaps_between_far_points_do_not_hold_the_robot_in_place():
    there = Pose2(0.35, 0.0, 0.0)
    variance = np.array([0.05, 0.05, 0.02]) ** 2
    found = search_near(surface_from(there), map_from(Pose2()), there, Window(0.4, 0.1), variance)
    assert error(found, there)[0] < 0.15


def test_a_place_is_found_in_a_wide_window_by_walls_fifty_metres_away():
    there, local_map = Pose2(4.0, -3.0, 0.2), map_from(Pose2())
    surface = surface_from(there)
    peak = search_far(surface, local_map.fit_for(surface), Pose2(), Window(8.0, 0.4), 0.5, apart=1.0)
    match = refine(surface, local_map, peak.base_pose, peak.base_pose, NO_BELIEF)
    distance, angle = error(match.base_pose, there)
    assert distance < 0.1 and angle < 0.002


def test_points_on_one_line_are_filled_in_and_corners_are_not():
    xs = np.array([0.0, 1.0, 2.0, 2.0, 2.0])
    ys = np.array([0.0, 0.0, 0.0, 1.0, 2.0])
    normals = np.array([[0.0, 1.0]] * 3 + [[-1.0, 0.0]] * 2)
    points = np.column_stack((xs, ys)).astype(np.float32)
    dense = filled(Surface(points, normals.astype(np.float32)), 0.3)
    assert len(dense) == 5 + 3 * 3
    between = dense.points_xy[(dense.points_xy[:, 0] == 2.0) & (dense.points_xy[:, 1] > 0.0)]
    assert between[:, 1].min() == 1.0


def test_where_half_of_the_beams_see_nothing_the_robot_is_followed_nonetheless():
    """A laser that says a centimetre less than its range, give or take one, draws a circle around itself."""
    rng, mapper = np.random.default_rng(0), Mapper(MapperSettings())
    odometry = Pose2()
    for step in range(60):
        pose = Pose2(0.3 * step, 0.0, 0.0)
        scan = scan_from(pose, float(step), rng.normal(0.0, 0.015, BEAMS))
        mapper.insert(odometry, scan)
        odometry = odometry @ Pose2(0.31, 0.0, 0.01)
    last_in_first = Pose2.from_array(mapper.key_poses[0]).inverse() @ mapper.last_in_map
    distance, angle = error(last_in_first, pose)
    assert distance < 0.3 and angle < 0.01


@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["forwards", "backwards"])
def test_odometry_that_takes_backwards_for_forwards_does_not_lose_the_robot(office, sign):
    drive = office.drive(laps=0.25)
    mapper, odometry, last = Mapper(MapperSettings()), Pose2(), drive[0]
    for sighting in drive:
        step = last.base_in_odom.inverse() @ sighting.base_in_odom
        odometry = odometry @ Pose2(sign * step.x, step.y, step.yaw)
        update = mapper.insert(odometry, sighting.scan)
        last = sighting
        if update is not None:
            assert update.response > 0.5
    last_in_first = Pose2.from_array(mapper.key_poses[0]).inverse() @ mapper.last_in_map
    assert error(last_in_first, drive[0].base_in_map.inverse() @ last.base_in_map)[0] < 0.1
