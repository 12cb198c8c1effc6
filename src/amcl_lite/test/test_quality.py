import math
from pathlib import Path

import numpy as np
import pytest

from amcl_lite.filter.particles import FreeSpace
from amcl_lite.recovery.hypotheses import find_hypotheses
from amcl_lite.recovery.quality import LOST_BELOW, LostDetector, ScanQuality, scan_quality
from amcl_lite.sensor.beams import Beams
from amcl_lite.sensor.likelihood_field import likelihood_field
from amcl_lite.sensor.scan_matching import match_scan
from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, grid_from_picture, load_map, wrap
from planar.geometry.ray_casting import cast_rays

FLAT = """
####################
#......#...........#
#......#...........#
#..................#
#......#.....####..#
#......#...........#
###..###...........#
#..................#
####################
"""
HOME = Path(__file__).resolve().parents[3] / "map/home.yaml"
MAX_RANGE = 8.0
HERE = Pose2(2.0, 1.9, 0.4)


def flat():
    """8 x 3.6 m, turned and moved."""
    return grid_from_picture(FLAT, 0.05, Pose2(0.0, 0.0, 0.0), scale=8)


GRID = flat()
FIELD = likelihood_field(GRID, 0.2, 2.0)


def beams_at(base_in_map, grid=GRID, count=90):
    directions = np.linspace(-math.pi, math.pi, count, endpoint=False)
    ranges = cast_rays(grid, base_in_map, directions, MAX_RANGE)
    return Beams(ranges, directions, MAX_RANGE, np.zeros(2))


def test_a_scan_at_its_own_pose_is_explained():
    quality = scan_quality(HERE, beams_at(HERE), FIELD, GRID)
    assert quality.probability > 0.99 and quality.explained > 0.9 and quality.through < 0.05
    assert quality.mean_distance < GRID.resolution


def test_a_scan_elsewhere_is_not():
    for x, y, yaw in FreeSpace(GRID).draw(50, np.random.default_rng(0)):
        elsewhere = Pose2(x, y, yaw)
        if elsewhere.distance_to(HERE) > 0.5:
            assert scan_quality(elsewhere, beams_at(HERE), FIELD, GRID).probability < 0.5


def test_people_in_the_way_do_not_make_the_robot_lost():
    beams = beams_at(HERE)
    ranges = beams.ranges.copy()
    ranges[10:37] = np.minimum(ranges[10:37], 0.6)
    crowded = Beams(ranges, beams.directions, MAX_RANGE, beams.start_xy)
    assert scan_quality(HERE, crowded, FIELD, GRID).probability > 0.9


def test_beams_through_walls_speak_against_a_pose():
    blind = Beams(np.full(9, MAX_RANGE), np.linspace(-1.0, 1.0, 9), MAX_RANGE, np.zeros(2))
    assert scan_quality(HERE, blind, FIELD, GRID).probability < 0.01


def test_a_scan_that_measured_nothing_proves_nothing():
    nothing = Beams(np.empty(0), np.empty(0), MAX_RANGE, np.zeros(2), unmeasured=90)
    assert scan_quality(HERE, nothing, FIELD, GRID).probability == 0.5


def test_a_few_beams_on_something_unmapped_do_not_make_a_robot_lost():
    beams = beams_at(HERE, count=6)
    cut_short = Beams(0.5 * beams.ranges, beams.directions, MAX_RANGE, beams.start_xy, unmeasured=60)
    quality = scan_quality(HERE, cut_short, FIELD, GRID)
    assert quality.explained < 0.2
    assert LOST_BELOW < quality.probability < 0.5


def of(probability):
    return ScanQuality(probability, 0.0, 0.0, 0.0)


def test_one_bad_scan_is_no_loss_but_two_seconds_of_them_are():
    detector = LostDetector()
    stamps = np.arange(40) * 0.1
    assert not any(detector.add(of(0.0 if i == 20 else 1.0), stamp) for i, stamp in enumerate(stamps))
    verdicts = [detector.add(of(0.0), 4.0 + stamp) for stamp in stamps]
    assert not verdicts[5] and verdicts[20]


def test_a_robot_is_found_again_only_when_scans_fit_for_a_while():
    detector = LostDetector(is_lost=True)
    assert detector.add(of(1.0), 0.0) and detector.add(of(1.0), 0.5)
    assert not detector.add(of(1.0), 3.0)


def test_what_is_lost_does_not_depend_on_the_scan_rate():
    losses = []
    for period in (0.025, 0.2):
        detector = LostDetector()
        stamp = 0.0
        while not detector.add(of(0.0), stamp):
            stamp += period
        losses.append(stamp)
    assert abs(losses[0] - losses[1]) <= 0.2


def test_time_that_jumps_back_changes_nothing():
    detector = LostDetector()
    detector.add(of(1.0), 100.0)
    assert not detector.add(of(0.0), 1.0)


@pytest.mark.parametrize("error", [(0.2, 0.1, 0.1), (-0.15, 0.2, -0.15), (0.0, -0.2, 0.2)])
def test_scan_matching_finds_the_pose_from_nearby(error):
    found = match_scan(HERE @ Pose2(*error), np.diag((0.3, 0.3, 0.2)) ** 2, beams_at(HERE).ends_xy, FIELD)
    assert found.distance_to(HERE) < 0.5 * GRID.resolution
    assert abs(wrap(found.yaw - HERE.yaw)) < 0.02


def test_scan_matching_works_in_a_turned_map():
    origin = Pose2(3.0, -1.0, 2.0)
    turned = OccupancyGrid(GRID.cells, GRID.resolution, origin)
    field = likelihood_field(turned, 0.2, 2.0)
    there = origin @ HERE
    found = match_scan(there @ Pose2(0.1, 0.1, 0.1), 0.1 * np.eye(3), beams_at(HERE).ends_xy, field)
    assert found.distance_to(there) < 0.5 * GRID.resolution


def test_along_a_corridor_the_guess_stands():
    cells = np.zeros((30, 600), dtype=np.int8)
    cells[:3] = cells[-3:] = 100
    corridor = OccupancyGrid(cells, 0.05)
    middle = Pose2(15.0, 0.75, 0.0)
    guess = middle @ Pose2(0.3, 0.1, 0.05)
    ends_xy = beams_at(middle, corridor).ends_xy
    found = match_scan(guess, np.diag((0.2, 0.2, 0.1)) ** 2, ends_xy, likelihood_field(corridor, 0.2, 2.0))
    assert abs(found.x - guess.x) < 0.03 and abs(found.y - middle.y) < 0.03 and abs(found.yaw) < 0.02


def test_what_is_not_on_the_map_is_not_matched_with_a_wall_out_of_reach():
    """Between a board that most beams meet and an outer wall, behind which the scan fits better."""
    home = load_map(HOME)
    with_board = home.cells.copy()
    board_xy = np.stack(np.meshgrid(np.arange(0.9, 3.1, 0.02), np.arange(3.9, 4.1, 0.02)), axis=-1).reshape(
        -1, 2
    )
    with_board[tuple(home.cells_of(board_xy).T)] = OCCUPIED
    here = Pose2(2.0, 4.43, 0.0)
    ends_xy = beams_at(here, OccupancyGrid(with_board, home.resolution, home.origin)).ends_xy
    found = match_scan(here, np.diag((0.08, 0.1, 0.07)) ** 2, ends_xy, likelihood_field(home, 0.2, 2.0))
    assert found.distance_to(here) < 0.05


def test_without_beams_the_guess_stands():
    guess = Pose2(1.0, 1.0, 0.5)
    found = match_scan(guess, 0.1 * np.eye(3), np.empty((0, 2)), FIELD)
    assert found.distance_to(guess) < 1e-9


def test_a_certain_guess_stands():
    guess = HERE @ Pose2(0.2, 0.0, 0.0)
    assert match_scan(guess, np.zeros((3, 3)), beams_at(HERE).ends_xy, FIELD).distance_to(guess) < 0.05


def test_the_true_place_is_among_the_hypotheses():
    rng = np.random.default_rng(0)
    hypotheses = find_hypotheses(beams_at(HERE), FIELD, GRID, FreeSpace(GRID), rng)
    nearest = min(Pose2.from_array(pose).distance_to(HERE) for pose in hypotheses.poses)
    assert nearest < 0.1 and len(hypotheses) <= 10
    assert hypotheses.draw(100, rng).shape == (100, 3)


def test_nothing_is_drawn_into_a_wall():
    beside_a_wall = Pose2(0.5, 2.9, 0.3)
    rng = np.random.default_rng(0)
    poses = find_hypotheses(beams_at(beside_a_wall), FIELD, GRID, FreeSpace(GRID), rng).draw(2000, rng)
    near = poses[np.hypot(*(poses[:, :2] - (beside_a_wall.x, beside_a_wall.y)).T) < 0.5]
    assert len(near) > 100
    assert {GRID.value_at(x, y) for x, y, _ in poses} == {FREE}


def test_a_scan_that_fits_nowhere_gives_no_hypothesis():
    nowhere = Beams(np.full(60, 7.0), np.linspace(-3.0, 3.0, 60), MAX_RANGE, np.zeros(2))
    assert len(find_hypotheses(nowhere, FIELD, GRID, FreeSpace(GRID), np.random.default_rng(0))) == 0
