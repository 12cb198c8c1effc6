import math

import numpy as np
import pytest

from explore_lite.frontiers import Frontier
from explore_lite.travel import travel_distances
from explore_lite.viewpoints import viewpoint_of
from planar import Pose2, grid_from_picture

WALL = """
.........
.........
....#....
....#....
....#....
"""


def test_the_way_leads_around_walls():
    grid = grid_from_picture(WALL)
    distances = travel_distances(grid, Pose2(0.5, 0.5), 0.0)
    assert distances[0, 3] == pytest.approx(3.0)
    assert distances[0, 8] == pytest.approx(6 * math.sqrt(2.0) + 2.0)
    assert np.isinf(distances[0, 4])


def test_the_way_keeps_clear_of_obstacles():
    grid = grid_from_picture("......\n..##..\n......\n......")
    distances = travel_distances(grid, Pose2(0.5, 0.5), 1.0)
    assert np.isinf(distances[1, 2:4]).all()
    assert distances[0, 5] == pytest.approx(5.0)


def test_beyond_a_gap_that_is_too_narrow_there_is_no_way():
    grid = grid_from_picture("...#...\n.......\n...#...")
    assert np.isinf(travel_distances(grid, Pose2(0.5, 1.5), 1.0)[1, 5])


def test_a_robot_close_to_a_wall_sets_out_from_the_nearest_clear_cell():
    grid = grid_from_picture("#....")
    assert travel_distances(grid, Pose2(1.6, 0.5), 1.0)[0, 4] == pytest.approx(2.0)
    assert np.isinf(travel_distances(grid, Pose2(0.4, 0.5), 1.0)).all()


def view(picture, middle_xy, robot=Pose2(0.5, 0.5), reach=3.0, shunned=()):
    grid = grid_from_picture(picture)
    distances = travel_distances(grid, robot, 0.5)
    frontier = Frontier(np.array([middle_xy]), 1.0)
    return viewpoint_of(frontier, grid, distances, robot, reach, list(shunned), 0.5)


def test_an_open_frontier_is_driven_to_and_faced_from_there_on():
    assert view("......\n......", [4.5, 0.5]) == Pose2(4.5, 0.5, 0.0)


def test_a_frontier_that_cannot_be_entered_is_looked_at_from_the_nearest_place():
    pose = view("......\n.....#\n......", [5.5, 0.5], robot=Pose2(0.5, 0.5), shunned=[Pose2(5.5, 0.5)])
    assert (pose.x, pose.y) == (4.5, 0.5)
    assert pose.yaw == pytest.approx(0.0)


def test_a_wall_in_between_spoils_the_view():
    assert view("...#..", [4.5, 0.5]) is None
    assert view("...#..\n......\n......", [4.5, 2.5], reach=1.0) is not None


def test_nothing_is_looked_at_from_too_far():
    assert view("...???", [5.5, 0.5], reach=2.5) is None
    assert view("...???", [5.5, 0.5], reach=3.5) is not None
