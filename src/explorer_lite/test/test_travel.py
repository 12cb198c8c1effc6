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


def test_the_way_leads_around_walls():
    distances = distances_in(WALL, Pose2(0.5, 0.5), 0.0)
    assert distances[0, 3] == pytest.approx(3.0)
    assert distances[0, 8] == pytest.approx(6.0 * math.sqrt(2.0) + 2.0)
    assert np.isinf(distances[0, 4])


def test_the_way_keeps_clear_of_obstacles():
    distances = distances_in("......\n..##..\n......\n......", Pose2(0.5, 0.5), 1.0)
    assert np.isinf(distances[1, 2:4]).all()
    assert distances[0, 5] == pytest.approx(5.0)


def test_beyond_a_gap_that_is_too_narrow_there_is_no_way():
    assert np.isinf(distances_in("...#...\n.......\n...#...", Pose2(0.5, 1.5), 1.0)[1, 5])


def test_between_obstacles_that_touch_at_a_corner_there_is_no_way():
    assert np.isinf(distances_in("..#\n##.", Pose2(0.5, 1.5), 0.0)[0, 2])


POCKET = """
##########
#........#
######...#
#........#
##########
"""


def test_a_robot_in_a_tight_place_may_leave_it_with_less_room():
    robot = Pose2(0.3, 0.3)
    distances = distances_in(POCKET, robot, 0.25, resolution=0.2)
    assert np.isfinite(distances[2, 7])
    assert np.isinf(distances[3, 8])


def test_a_robot_that_does_not_see_the_floor_around_it_may_leave_through_the_unknown():
    distances = distances_in("??........\n??........\n??........", Pose2(0.1, 0.3), 0.1, resolution=0.2)
    assert np.isfinite(distances[1, 9])


def test_a_robot_far_from_all_that_is_free_cannot_go_anywhere():
    assert np.isinf(distances_in("...", Pose2(-5.0, 0.5), 0.1)).all()


def view(picture, middle_xy, robot=Pose2(0.5, 0.5), reach=3.0, excluded=()):
    grid = grid_from_picture(picture)
    distances = distances_in(picture, robot, 0.5)
    frontier = Frontier(np.array([middle_xy]), 1.0)
    return viewpoint_of(frontier, grid, distances, robot, reach, list(excluded), 0.5)


def test_an_open_frontier_is_driven_to_and_faced_from_there_on():
    assert view("......\n......", [4.5, 0.5]) == Pose2(4.5, 0.5, 0.0)


def test_a_frontier_that_cannot_be_entered_is_looked_at_from_the_nearest_place():
    pose = view("......\n.....#\n......", [5.5, 0.5], robot=Pose2(0.5, 0.5), excluded=[Pose2(5.5, 0.5)])
    assert (pose.x, pose.y) == (4.5, 0.5)
    assert pose.yaw == pytest.approx(0.0)


def test_a_wall_in_between_spoils_the_view():
    assert view("...#..", [4.5, 0.5]) is None
    assert view("...#..\n......\n......", [4.5, 2.5], reach=1.0) is not None


def test_nothing_is_looked_at_from_too_far():
    assert view("...???", [5.5, 0.5], reach=2.5) is None
    assert view("...???", [5.5, 0.5], reach=3.5) is not None
