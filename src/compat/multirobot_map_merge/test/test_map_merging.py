"""Maps of several robots are merged at their poses."""

import math

import numpy as np
import pytest

from multirobot_map_merge.map_merging import merge_maps
from planar import OCCUPIED, UNKNOWN, PlanarError, Pose2, grid_from_picture

ROOM = grid_from_picture("####\n#..#\n####", 0.5)


def test_one_map_is_unchanged():
    merged = merge_maps([(Pose2(), ROOM)])
    assert np.array_equal(merged.cells, ROOM.cells)
    assert (merged.origin, merged.resolution) == (ROOM.origin, 0.5)


def test_two_maps_are_merged_and_cells_between_them_are_unknown():
    merged = merge_maps([(Pose2(), ROOM), (Pose2(3.0, 0.0), ROOM)])
    assert merged.cells.shape == (3, 10)
    assert (merged.cells[:, 4:6] == UNKNOWN).all()
    assert np.array_equal(merged.cells[:, 6:], ROOM.cells)


def test_a_map_may_be_rotated():
    merged = merge_maps([(Pose2(0.0, 0.0, math.pi / 2.0), ROOM)])
    assert (merged.cells == OCCUPIED).sum() == (ROOM.cells == OCCUPIED).sum()
    assert merged.cells.shape in [(4, 3), (5, 3), (4, 4), (5, 4)]


def test_the_more_occupied_of_two_values_is_used():
    free = grid_from_picture("....\n....\n....", 0.5)
    assert np.array_equal(merge_maps([(Pose2(), free), (Pose2(), ROOM)]).cells, ROOM.cells)


def test_a_pose_too_far_away_is_rejected():
    with pytest.raises(PlanarError, match="the merged map would have"):
        merge_maps([(Pose2(), ROOM), (Pose2(1e7, 1e7), ROOM)])
