import math

import numpy as np
import pytest

from explorer_lite.frontiers import Frontier
from explorer_lite.travel import travel_distances
from explorer_lite.viewpoints import viewpoint_of
from planar import OCCUPIED, Pose2, grid_from_picture
from planar.geometry.distance_field import distance_field

WALL = """
.........
.........
....#....
....#....
....#....
"""


def distances_in(picture, robot, clearance, resolution=1.0):
    grid = grid_from_picture(picture, resolution)
    return travel_distances(grid, distance_field(grid.cells == OCCUPIED, resolution), robot, clearance)


def test_paths_lead_around_walls():
    distances = distances_in(WALL, Pose2(0.5, 0.5), 0.0)
    assert distances[0, 3] == pytest.approx(3.0)
    assert distances[0, 8] == pytest.approx(6.0 * math.sqrt(2.0) + 2.0)
    assert np.isinf(distances[0, 4])


def test_paths_keep_the_clearance():
    distances = distances_in("......\n..##..\n......\n......", Pose2(0.5, 0.5), 1.0)
    assert np.isinf(distances[1, 2:4]).all()
    assert distances[0, 5] == pytest.approx(5.0)


def test_a_narrow_gap_is_impassable():
    assert np.isinf(distances_in("...#...\n.......\n...#...", Pose2(0.5, 1.5), 1.0)[1, 5])


def test_paths_do_not_lead_between_obstacles_that_touch_at_a_corner():
    assert np.isinf(distances_in("..#\n##.", Pose2(0.5, 1.5), 0.0)[0, 2])


POCKET = """
##########
#........#
######...#
#........#
##########
"""


def test_a_robot_in_a_tight_place_may_leave_it_with_less_clearance():
    robot = Pose2(0.3, 0.3)
    distances = distances_in(POCKET, robot, 0.25, resolution=0.2)
    assert np.isfinite(distances[2, 7])
    assert np.isinf(distances[3, 8])


def test_a_robot_in_unknown_cells_may_leave_through_them():
    distances = distances_in("??........\n??........\n??........", Pose2(0.1, 0.3), 0.1, resolution=0.2)
    assert np.isfinite(distances[1, 9])


def test_a_robot_far_from_free_space_reaches_nothing():
    assert np.isinf(distances_in("...", Pose2(-5.0, 0.5), 0.1)).all()


def view(picture, middle_xy, robot=Pose2(0.5, 0.5), reach=3.0, excluded=()):
    grid = grid_from_picture(picture)
    distances = distances_in(picture, robot, 0.5)
    frontier = Frontier(np.array([middle_xy]), 1.0)
    return viewpoint_of(frontier, grid, distances, robot, reach, list(excluded), 0.5)


def test_the_viewpoint_of_a_reachable_frontier_is_on_it():
    assert view("......\n......", [4.5, 0.5]) == Pose2(4.5, 0.5, 0.0)


def test_an_unreachable_frontier_is_viewed_from_the_nearest_cell():
    pose = view("......\n.....#\n......", [5.5, 0.5], robot=Pose2(0.5, 0.5), excluded=[Pose2(5.5, 0.5)])
    assert (pose.x, pose.y) == (4.5, 0.5)
    assert pose.yaw == pytest.approx(0.0)


def test_a_wall_blocks_the_view():
    assert view("...#..", [4.5, 0.5]) is None
    assert view("...#..\n......\n......", [4.5, 2.5], reach=1.0) is not None


def test_a_viewpoint_is_within_reach():
    assert view("...???", [5.5, 0.5], reach=2.5) is None
    assert view("...???", [5.5, 0.5], reach=3.5) is not None
