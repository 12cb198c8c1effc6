import math

import numpy as np
import pytest

from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, PlanarError, Pose2
from planar.maps.map_score import score_map, visible_walls

RESOLUTION = 0.05
ORIGIN = Pose2(-2.0, -1.0)
START = Pose2(0.0, 0.0)


def box_room(rows=60, cols=100):
    """A room of 5 x 3 m with walls two cells thick, unknown around it."""
    cells = np.full((rows, cols), UNKNOWN, dtype=np.int8)
    cells[4:-4, 4:-4] = OCCUPIED
    cells[6:-6, 6:-6] = FREE
    return OccupancyGrid(cells, RESOLUTION, ORIGIN)


def changed(grid, rows, cols, value):
    cells = grid.cells.copy()
    cells[rows, cols] = value
    return OccupancyGrid(cells, grid.resolution, grid.origin)


def test_the_true_map_is_perfect():
    score = score_map(box_room(), box_room(), START)
    assert (score.recall, score.precision, score.doubled_walls) == (1.0, 1.0, 0)


def test_only_visible_walls_have_to_be_mapped():
    room = box_room()
    inner = visible_walls(room, START, 0.18, 10.0)
    assert set(inner[:, 0]) == set(range(5, 55))
    assert not (inner == 4).any()
    closet = changed(room, slice(20, 40), slice(60, 80), OCCUPIED)
    closet = changed(closet, slice(25, 35), slice(65, 75), FREE)
    seen = visible_walls(closet, START, 0.18, 10.0)
    inside = (seen > [21, 61]).all(axis=1) & (seen < [38, 78]).all(axis=1)
    assert not inside.any()


def test_a_wall_that_is_missing_costs_recall():
    score = score_map(changed(box_room(), slice(0, 6), slice(None), FREE), box_room(), START)
    # 88 of 272 inner wall cells are gone, less the two at either end that lie near the side walls
    assert score.recall == pytest.approx(1.0 - 84.0 / 272.0, abs=0.02)
    assert score.precision == 1.0


def test_a_wall_that_does_not_exist_costs_precision():
    score = score_map(changed(box_room(), slice(20, 40), 50, OCCUPIED), box_room(), START)
    assert score.recall == 1.0
    walls = np.count_nonzero(box_room().cells == OCCUPIED)
    assert score.precision == pytest.approx(walls / (walls + 20.0))


@pytest.mark.parametrize("shift, is_good", [(0.08, True), (0.20, False)])
def test_walls_may_be_displaced_by_the_tolerance(shift, is_good):
    room = box_room()
    moved = OccupancyGrid(room.cells, room.resolution, Pose2(shift, 0.0) @ room.origin)
    score = score_map(moved, room, START)
    assert (min(score.recall, score.precision) == 1.0) == is_good


def test_a_map_may_be_in_a_frame_other_than_the_truth():
    truth_in_map = Pose2(3.0, -1.0, math.radians(30.0))
    room = box_room()
    turned = OccupancyGrid(room.cells, room.resolution, truth_in_map @ room.origin)
    score = score_map(turned, room, START, truth_in_map)
    assert (score.recall, score.precision) == (1.0, 1.0)


def test_a_wall_drawn_twice_is_counted():
    doubled = changed(box_room(), slice(6, 54), 10, OCCUPIED)
    assert score_map(doubled, box_room(), START).doubled_walls == 1


def test_a_true_narrow_gap_is_no_doubled_wall():
    truth = changed(box_room(), slice(6, 54), 10, OCCUPIED)
    assert score_map(truth, truth, START).doubled_walls == 0


def test_a_second_wall_far_away_is_counted():
    doubled = changed(box_room(), slice(20, 40), 20, OCCUPIED)
    assert score_map(doubled, box_room(), START).doubled_walls == 1


def test_a_wall_in_the_wrong_place_is_not_drawn_twice():
    moved = changed(changed(box_room(), slice(6, 54), 4, FREE), slice(6, 54), 5, FREE)
    moved = changed(moved, slice(8, 52), 10, OCCUPIED)
    assert score_map(moved, box_room(), START).doubled_walls == 0


def test_a_gap_too_narrow_for_the_true_grid_is_no_doubled_wall():
    fine = OccupancyGrid(np.kron(box_room().cells, np.ones((5, 5), dtype=np.int8)), RESOLUTION / 5, ORIGIN)
    cupboard_and_gap = changed(
        changed(fine, slice(30, 60), slice(100, 200), OCCUPIED), slice(30, 33), slice(100, 200), FREE
    )
    closed = changed(box_room(), slice(6, 12), slice(20, 40), OCCUPIED)
    mapped = changed(closed, 6, slice(30, 40), FREE)
    assert score_map(mapped, closed, START).doubled_walls == 1
    assert score_map(mapped, closed, START, fine_truth=cupboard_and_gap).doubled_walls == 0


def test_the_corner_beside_a_cupboard_is_no_doubled_wall():
    truth = changed(box_room(), slice(6, 12), slice(20, 40), OCCUPIED)
    rim_too_far = changed(truth, 11, 19, OCCUPIED)
    assert score_map(rim_too_far, truth, START).doubled_walls == 0


def test_an_empty_map_scores_nothing():
    empty = changed(box_room(), slice(None), slice(None), UNKNOWN)
    assert score_map(empty, box_room(), START).recall == 0.0


def test_a_start_in_a_wall_is_refused():
    with pytest.raises(PlanarError, match="cannot stand"):
        score_map(box_room(), box_room(), Pose2(-1.75, 0.0))
