import math

import numpy as np
import pytest

from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, PlanarError, Pose2, grid_from_picture
from planar.geometry.distance_field import distance_field
from planar.geometry.ray_casting import cast_rays


def test_the_lowest_line_of_a_picture_is_row_zero():
    grid = grid_from_picture("#.\n.?")
    assert grid.cells.tolist() == [[FREE, UNKNOWN], [OCCUPIED, FREE]]


def test_cells_and_points_are_each_others_inverse_under_a_turned_origin():
    grid = grid_from_picture("...\n...", resolution=0.5, origin=Pose2(1.0, 2.0, 0.3))
    cells = np.array([[0, 0], [1, 2]])
    assert grid.cells_of(grid.points_of(cells)).tolist() == cells.tolist()


def test_cells_outside_the_grid_are_unknown():
    assert grid_from_picture("##\n##").value_at(5.0, 5.0) == UNKNOWN


def test_a_grid_without_cells_is_refused():
    with pytest.raises(PlanarError, match="rows and columns"):
        OccupancyGrid(np.zeros((0, 3), np.int8), 0.05)


def test_distances_are_measured_between_cell_centres_and_clipped():
    grid = grid_from_picture("#....", resolution=0.5)
    distances = distance_field(grid.cells == OCCUPIED, 0.5, max_distance=1.5)
    assert distances[0].tolist() == [0.0, 0.5, 1.0, 1.5, 1.5]


ROOM = """
#######
#.....#
#.....#
#.....#
#######
"""


def test_rays_end_at_the_walls_of_a_room():
    grid = grid_from_picture(ROOM, resolution=1.0)
    angles = np.array([0.0, math.pi / 2, math.pi, -math.pi / 2, math.pi / 4])
    ranges = cast_rays(grid, Pose2(3.5, 2.5), angles, max_range=10.0)
    assert ranges == pytest.approx([2.5, 1.5, 2.5, 1.5, 1.5 * math.sqrt(2)])


def test_a_ray_that_hits_nothing_has_the_maximum_range():
    grid = grid_from_picture("...", resolution=1.0)
    assert cast_rays(grid, Pose2(1.5, 0.5), np.array([0.3]), 4.0) == pytest.approx([4.0])


def test_rays_follow_the_origin_of_the_grid():
    origin = Pose2(10.0, -5.0, 1.1)
    grid = grid_from_picture(ROOM, resolution=1.0, origin=origin)
    ranges = cast_rays(grid, origin @ Pose2(3.5, 2.5, 0.0), np.array([0.0]), 10.0)
    assert ranges == pytest.approx([2.5])
