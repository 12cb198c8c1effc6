"""Outdoors, where walls are outside of the fine grid."""

import math

import numpy as np
import pytest

from planar import Pose2, Scan, wrap
from slam_lite.config import MapperSettings
from slam_lite.mapper import Mapper
from slam_lite.matching.correlative import SearchWindow, search_branch_and_bound, search_exhaustively
from slam_lite.matching.local_map import long_range_map
from slam_lite.matching.refinement import refine
from slam_lite.point_cloud import PointCloud, interpolated, point_cloud_of

BEAMS = 180
ANGLES = np.linspace(-math.pi / 2.0, math.pi / 2.0, BEAMS)
NO_PRIOR = np.zeros((3, 3))
# Ends (x0, y0), (x1, y1) of walls far from the origin, all visible from it.
WALLS = np.array([[60.0, -30.0, 52.0, 25.0], [40.0, -45.0, 60.0, -30.0], [10.0, 48.0, 52.0, 25.0]])


def ranges_from(pose, walls=WALLS, no_return=80.0):
    """Range to the nearest wall along each beam, (BEAMS,), without noise."""
    ranges = np.full(BEAMS, no_return)
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


def cloud_from(pose):
    return point_cloud_of(scan_from(pose), 79.9, 0.03)


def map_from(pose):
    local_map = long_range_map()
    local_map.clear(pose)
    local_map.add(cloud_from(pose), pose)
    return local_map


def error(one, other):
    return one.distance_to(other), abs(wrap(one.yaw - other.yaw))


def test_a_step_is_measured_by_walls_fifty_metres_away():
    there = Pose2(0.35, 0.02, 0.03)
    local_map, guess = map_from(Pose2()), Pose2(0.15, 0.1, 0.06)
    start = search_exhaustively(cloud_from(there), local_map, guess, SearchWindow(0.4, 0.1), np.full(3, 0.04))
    match = refine(cloud_from(there), local_map, start, start, NO_PRIOR)
    distance, angle = error(match.base_pose, there)
    assert distance < 0.05 and angle < 0.001
    assert match.response > 0.9


def test_the_gaps_between_far_points_do_not_hold_the_robot_in_place():
    there = Pose2(0.35, 0.0, 0.0)
    variance = np.array([0.05, 0.05, 0.02]) ** 2
    found = search_exhaustively(cloud_from(there), map_from(Pose2()), there, SearchWindow(0.4, 0.1), variance)
    assert error(found, there)[0] < 0.15


def test_a_pose_is_found_in_a_wide_window_by_walls_fifty_metres_away():
    there, local_map = Pose2(4.0, -3.0, 0.2), map_from(Pose2())
    cloud = cloud_from(there)
    peak = search_branch_and_bound(
        cloud, local_map.layer_for(cloud), Pose2(), SearchWindow(8.0, 0.4), 0.5, apart=1.0
    )
    match = refine(cloud, local_map, peak.base_pose, peak.base_pose, NO_PRIOR)
    distance, angle = error(match.base_pose, there)
    assert distance < 0.1 and angle < 0.002


def test_points_on_one_line_are_interpolated_and_corners_are_not():
    xs = np.array([0.0, 1.0, 2.0, 2.0, 2.0])
    ys = np.array([0.0, 0.0, 0.0, 1.0, 2.0])
    normals = np.array([[0.0, 1.0]] * 3 + [[-1.0, 0.0]] * 2)
    points = np.column_stack((xs, ys)).astype(np.float32)
    dense = interpolated(PointCloud(points, normals.astype(np.float32)), 0.3)
    assert len(dense) == 5 + 3 * 3
    between = dense.points_xy[(dense.points_xy[:, 0] == 2.0) & (dense.points_xy[:, 1] > 0.0)]
    assert between[:, 1].min() == 1.0


def test_the_robot_is_tracked_although_half_of_the_beams_have_no_return():
    """This laser reports about a centimetre less than its range, which forms a circle around it."""
    rng, mapper = np.random.default_rng(0), Mapper(MapperSettings())
    odometry = Pose2()
    for step in range(60):
        pose = Pose2(0.3 * step, 0.0, 0.0)
        scan = scan_from(pose, float(step), rng.normal(0.0, 0.015, BEAMS))
        mapper.insert(odometry, scan)
        odometry = odometry @ Pose2(0.31, 0.0, 0.01)
    last_in_first = Pose2.from_array(mapper.keyframe_poses[0]).inverse() @ mapper.base_in_map
    distance, angle = error(last_in_first, pose)
    assert distance < 0.3 and angle < 0.01


@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["forwards", "backwards"])
def test_odometry_with_the_wrong_sign_does_not_lose_the_robot(office, sign):
    drive = office.drive(laps=0.25)
    mapper, odometry, last = Mapper(MapperSettings()), Pose2(), drive[0]
    for observation in drive:
        step = last.base_in_odom.inverse() @ observation.base_in_odom
        odometry = odometry @ Pose2(sign * step.x, step.y, step.yaw)
        update = mapper.insert(odometry, observation.scan)
        last = observation
        if update is not None:
            assert update.response > 0.5
    last_in_first = Pose2.from_array(mapper.keyframe_poses[0]).inverse() @ mapper.base_in_map
    assert error(last_in_first, drive[0].base_in_map.inverse() @ last.base_in_map)[0] < 0.1
