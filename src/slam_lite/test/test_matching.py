import math

import numpy as np
import pytest
from numba import _dispatcher

from planar import Pose2, wrap
from slam_lite.angular_coverage import AngularCoverage
from slam_lite.config import MapperSettings
from slam_lite.front_end import FrontEnd, RecentKeyframes
from slam_lite.matching.correlative import (
    SearchWindow,
    _bounds_of_few,
    _bounds_of_many,
    _maxima,
    _phases,
    search_branch_and_bound,
    search_exhaustively,
)
from slam_lite.matching.local_map import LocalMap, long_range_map
from slam_lite.matching.refinement import refine
from slam_lite.point_cloud import PointCloud, point_cloud_of

HERE = Pose2(6.5, 2.2, 0.2)
NO_PRIOR = np.zeros((3, 3))


def cloud_at(office, pose):
    return point_cloud_of(office.scan(pose), 20.0, 0.03)


def local_map_at(office, *poses):
    local_map = LocalMap()
    local_map.clear(poses[0])
    for pose in poses:
        local_map.add(cloud_at(office, pose), pose)
    return local_map


def error(one, other):
    return one.distance_to(other), abs(wrap(one.yaw - other.yaw))


def test_a_scan_matches_itself_exactly(office):
    local_map = local_map_at(office, HERE)
    start = HERE @ Pose2(0.05, -0.04, 0.03)
    match = refine(cloud_at(office, HERE), local_map, start, start, NO_PRIOR)
    distance, angle = error(match.base_pose, HERE)
    assert distance < 1e-3 and angle < 1e-3
    assert match.response > 0.99


def test_kernels_recognize_the_type_of_a_local_map_from_call_to_call():
    """numba 0.58 loses the first 40 bytes of a longer key, and finds the type of the argument again."""
    keys = [_dispatcher.compute_fingerprint(part) for part in long_range_map().packed_layers]
    assert max(len(key) for key in keys) <= 40


def test_each_cell_near_a_point_stores_its_nearest_one():
    rng, local_map = np.random.default_rng(5), LocalMap(0.05, 2.0)
    local_map.clear(Pose2())
    for _ in range(8):
        points = rng.uniform(-1.0, 1.0, (40, 2)).astype(np.float32)
        local_map.add(PointCloud(points, np.zeros_like(points)), Pose2(0.1, -0.2, 0.7))
    points = local_map.points_xy[: local_map.count] / local_map.resolution
    rows, cols = np.nonzero(local_map.nearest >= 0)
    centers = np.column_stack((cols, rows)) + 0.5
    stored = np.hypot(*(centers - points[local_map.nearest[rows, cols]]).T)
    distances = np.hypot(*(centers[:, None] - points).transpose(2, 0, 1))
    is_in_square = np.abs(np.floor(points) + 0.5 - centers[:, None]).max(axis=2) <= 6.0
    np.testing.assert_allclose(stored, np.where(is_in_square, distances, np.inf).min(axis=1), atol=1e-4)
    expected = 255.0 * np.exp(-0.125 * np.floor(stored**2))
    assert np.mean(np.abs(local_map.likelihood[rows, cols] - expected) <= 0.5) > 0.999


def test_refinement_finds_the_step_between_two_scans_to_a_centimetre(office):
    there = HERE @ Pose2(0.3, 0.02, 0.1)
    match = refine(cloud_at(office, there), local_map_at(office, HERE), HERE, HERE, NO_PRIOR)
    distance, angle = error(match.base_pose, there)
    assert distance < 0.01 and angle < 0.003


def test_along_a_bare_wall_a_match_has_no_information(office):
    wall_xy = np.column_stack((np.arange(-3.0, 3.0, 0.05), np.full(120, 1.0))).astype(np.float32)
    wall = PointCloud(wall_xy, np.tile(np.array([0.0, 1.0], dtype=np.float32), (120, 1)))
    local_map = LocalMap()
    local_map.clear(Pose2())
    local_map.add(wall, Pose2())
    match = refine(wall, local_map, Pose2(0.2, 0.1, 0.0), Pose2(0.2, 0.1, 0.0), NO_PRIOR)
    assert abs(match.base_pose.y) < 1e-3
    assert match.information[0, 0] < 1e-3 * match.information[1, 1]


def test_a_wall_is_not_taken_for_its_other_side():
    length = np.arange(-1.0, 1.0, 0.03)
    front = np.column_stack((length, np.zeros_like(length))).astype(np.float32)
    back = front + np.array([0.0, 0.15], dtype=np.float32)
    up = np.tile(np.array([0.0, 1.0], dtype=np.float32), (len(front), 1))
    local_map = LocalMap()
    local_map.clear(Pose2())
    local_map.add(PointCloud(front, -up), Pose2())
    match = refine(PointCloud(back, up), local_map, Pose2(), Pose2(), np.eye(3))
    assert match.response == 0.0
    assert error(match.base_pose, Pose2()) == (0.0, 0.0)


def test_the_end_of_a_wall_does_not_pull_one_side_to_the_other():
    along, end = np.arange(0.0, 1.0, 0.03), np.arange(0.0, 0.15, 0.03)
    far = np.column_stack((np.arange(-3.0, 3.0, 0.03), np.full(200, 3.0)))
    left, right = (np.column_stack((np.full(len(along), x), along)) for x in (2.0, 2.15))
    cap = np.column_stack((2.0 + end, np.zeros(len(end))))  # too short for a line

    def seen(side, normal, *more):
        points = np.concatenate((far, side, *more))
        normals = np.zeros_like(points)
        normals[: len(far)] = (0.0, -1.0)
        normals[len(far) : len(far) + len(side)] = (normal, 0.0)
        return PointCloud(points.astype(np.float32), normals.astype(np.float32))

    local_map = LocalMap()
    local_map.clear(Pose2())
    local_map.add(seen(left, -1.0), Pose2())
    match = refine(seen(right, 1.0, cap), local_map, Pose2(), Pose2(), np.zeros((3, 3)))
    assert match.base_pose.distance_to(Pose2()) < 0.01


def test_normals_point_to_where_the_surface_was_seen_from(office):
    cloud = cloud_at(office, HERE)
    has_normal = cloud.normals_xy.any(axis=1)
    towards = -(cloud.points_xy * cloud.normals_xy).sum(axis=1)
    assert has_normal.mean() > 0.9
    assert (towards[has_normal] >= 0.0).all()


def test_directions_beside_the_field_of_view_are_unseen(office):
    narrow = point_cloud_of(office.scan(HERE, field_of_view=1.0), 20.0, 0.03)
    coverage = AngularCoverage(narrow, HERE)
    assert coverage.unseen_fraction(narrow, HERE) == 0.0
    assert coverage.unseen_fraction(narrow, HERE @ Pose2(0.0, 0.0, 0.5)) > 0.2
    assert coverage.unseen_fraction(narrow, HERE @ Pose2(0.0, 0.0, 2.0)) == 1.0


def test_the_prior_decides_without_points():
    nothing = PointCloud(np.empty((0, 2), dtype=np.float32), np.empty((0, 2), dtype=np.float32))
    local_map = LocalMap()
    local_map.clear(Pose2())
    match = refine(nothing, local_map, Pose2(), Pose2(0.1, 0.2, 0.3), 100.0 * np.eye(3))
    distance, angle = error(match.base_pose, Pose2(0.1, 0.2, 0.3))
    assert distance < 1e-6 and angle < 1e-6


def test_an_exhaustive_search_brings_refinement_within_reach(office):
    local_map = local_map_at(office, HERE)
    guess, variance = HERE @ Pose2(0.25, -0.2, 0.25), np.array([0.1, 0.1, 0.1]) ** 2
    start = search_exhaustively(cloud_at(office, HERE), local_map, guess, SearchWindow(0.3, 0.3), variance)
    distance, angle = error(start, HERE)
    assert distance < 0.15 and angle < 0.03


def test_branch_and_bound_finds_the_pose_in_a_wide_window(office):
    local_map = local_map_at(office, *(HERE @ Pose2(d, 0.0, 0.0) for d in (0.0, -1.0, -2.0, 1.0)))
    guess = HERE @ Pose2(3.0, -1.0, 0.6)
    peak = search_branch_and_bound(
        cloud_at(office, HERE), local_map, guess, SearchWindow(5.0, 0.8), 0.5, apart=0.6
    )
    distance, angle = error(peak.base_pose, HERE)
    assert distance < 0.1 and angle < 0.02
    assert peak.is_unique and not peak.degenerate_direction.any()


def test_branch_and_bound_finds_what_trying_every_pose_finds(office):
    local_map = local_map_at(office, HERE)
    cloud = cloud_at(office, HERE @ Pose2(0.5, 0.1, 0.0))
    peak = search_branch_and_bound(cloud, local_map, HERE, SearchWindow(1.0, 1e-6), 0.1, apart=0.5)
    start = local_map.to_grid(HERE)
    c, s = math.cos(start[2]), math.sin(start[2])
    points = cloud.points_xy.astype(np.float64) @ np.array([[c, s], [-s, c]]) + start[:2]
    cols, rows = np.floor(points / local_map.resolution).astype(int).T
    cells = range(-20, 21)
    best = max(local_map.likelihood[rows + dv, cols + du].mean() / 255.0 for du in cells for dv in cells)
    assert peak.score == np.float64(best)


def test_places_alike_are_not_unique():
    local_map = LocalMap()
    local_map.clear(Pose2())
    for x, y in ((0.0, 0.0), (2.0, 0.0), (0.0, 2.0)):
        local_map.add(niche(), Pose2(x, y))
    assert not search_branch_and_bound(
        niche(), local_map, Pose2(), SearchWindow(3.0, 0.05), 0.3, apart=0.5
    ).is_unique


def test_places_alike_along_a_line_are_a_degenerate_direction():
    local_map = LocalMap()
    local_map.clear(Pose2())
    for x in (0.0, 1.0, 2.0):
        local_map.add(niche(), Pose2(x, 0.5 * x))
    peak = search_branch_and_bound(niche(), local_map, Pose2(), SearchWindow(3.0, 0.05), 0.3, apart=0.5)
    assert peak.is_unique
    np.testing.assert_allclose(
        np.abs(peak.degenerate_direction), [2.0 / math.sqrt(5.0), 1.0 / math.sqrt(5.0)], atol=0.05
    )


def niche() -> PointCloud:
    points = np.column_stack((np.array([0.0, 0.1, 0.2, 0.3]), np.full(4, 1.0)))
    return PointCloud(points.astype(np.float32), np.zeros((4, 2), dtype=np.float32))


def test_without_a_good_match_there_is_no_peak(office):
    local_map = local_map_at(office, HERE)
    elsewhere = cloud_at(office, Pose2(14.0, 6.0, 1.6))
    assert search_branch_and_bound(elsewhere, local_map, HERE, SearchWindow(1.0, 0.3), 0.8, apart=0.5) is None


def test_points_are_downsampled_and_walls_have_normals(office):
    cloud = cloud_at(office, HERE)
    steps = np.hypot(*np.diff(cloud.points_xy, axis=0).T)
    assert steps.min() >= 0.03
    lengths = np.hypot(*cloud.normals_xy.T)
    assert np.mean(np.abs(lengths - 1.0) < 1e-5) > 0.8
    assert np.all((np.abs(lengths - 1.0) < 1e-5) | (lengths == 0.0))


@pytest.mark.parametrize("at", [(500, 450), (4000, 450), (-3000, 450), (500, 4000), (500, -3000)])
def test_many_coarse_shifts_are_bounded_as_few_are_also_off_the_map(office, at):
    local_map = local_map_at(office, HERE)
    coarse = _maxima(local_map.likelihood)[-1]
    cloud = cloud_at(office, HERE)
    cells = np.floor(cloud.points_xy / local_map.resolution).astype(np.int64)[None] + [[at]]
    few, many = _bounds_of_few, _bounds_of_many
    cols, rows = (np.ascontiguousarray(cells[:, :, axis]) for axis in (0, 1))
    assert np.array_equal(few(coarse, cols, rows, 100), many(_phases(coarse), cols, rows, 100))


@pytest.mark.parametrize("points, follows", [(10, False), (100, True)], ids=["few", "many"])
def test_a_few_points_that_move_along_do_not_overrule_odometry(points, follows):
    """In an empty yard a person who walks beside the robot may be all that it sees."""
    around = np.linspace(0.0, 2.0, points)
    seen = np.column_stack((2.0 + 0.2 * np.sin(7.0 * around), around - 1.0)).astype(np.float32)
    person = PointCloud(seen, np.zeros_like(seen))
    local_map = LocalMap()
    local_map.clear(Pose2())
    local_map.add(person, Pose2())
    found = search_exhaustively(
        person, local_map, Pose2(0.35, 0.0, 0.0), SearchWindow(0.4, 0.1), np.full(3, 0.03**2)
    )
    assert (found.distance_to(Pose2()) < 0.1) == follows


def test_the_few_points_of_a_person_are_not_searched_in_a_wide_window():
    """They match anywhere."""
    seen = np.column_stack((np.full(10, 2.0), np.linspace(-0.3, 0.3, 10))).astype(np.float32)
    person = PointCloud(seen, np.zeros_like(seen))
    front_end = FrontEnd(MapperSettings(), RecentKeyframes(50))
    front_end.track(Pose2(), person)
    front_end._keyframes.add(person, Pose2())
    tracked = front_end.track(Pose2(0.7, 0.0, 0.0), person)
    assert tracked.base_in_track.distance_to(Pose2(0.7, 0.0, 0.0)) < 0.05
