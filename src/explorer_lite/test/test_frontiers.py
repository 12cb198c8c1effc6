import numpy as np
import pytest

from explorer_lite.frontiers import find_frontiers, known_part
from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, Pose2, grid_from_picture


def middles(frontiers):
    return sorted(tuple(frontier.middle_xy.tolist()) for frontier in frontiers)


def test_frontiers_are_free_cells_beside_unknown_space():
    grid = known_part(grid_from_picture("#####\n#..??\n#..??\n#..??\n#####"))
    (frontier,) = find_frontiers(grid, 1.0, 10.0)
    assert sorted(map(tuple, frontier.points_xy.tolist())) == [(2.5, 1.5), (2.5, 2.5), (2.5, 3.5)]
    assert frontier.size == 3.0
    assert frontier.middle_xy.tolist() == [2.5, 2.5]


def test_what_lies_beyond_the_grid_is_unknown():
    assert middles(find_frontiers(grid_from_picture("####\n#...\n####"), 1.0, 10.0)) == [(3.5, 1.5)]


def test_separate_openings_are_separate_frontiers():
    grid = known_part(grid_from_picture("##?##\n#...#\n#...#\n#...#\n##?##"))
    assert len(find_frontiers(grid, 1.0, 10.0)) == 2


def test_small_frontiers_are_ignored():
    grid = known_part(grid_from_picture("##?###\n#....?\n#....?\n#....?\n######"))
    assert len(find_frontiers(grid, 2.0, 10.0)) == 1


def test_long_frontiers_are_split():
    grid = known_part(grid_from_picture("....\n" * 12))
    parts = find_frontiers(grid, 1.0, 4.0)
    assert all(np.ptp(part.points_xy, axis=0).max() < 4.0 for part in parts)
    cells = {point for part in parts for point in map(tuple, part.points_xy.tolist())}
    assert len(cells) == sum(len(part.points_xy) for part in parts) == 2 * 4 + 2 * 10


def test_a_large_grid_is_cropped_to_its_known_part():
    cells = np.full((500, 400), UNKNOWN, dtype=np.int8)
    cells[200:203, 100:104] = [[0, 10, 25, 0], [0, 60, 65, 0], [100, 99, 0, 0]]
    vast = OccupancyGrid(cells, 0.5, Pose2(-10.0, -20.0, 0.3))
    part = known_part(vast)
    assert part.cells[1:-1, 1:-1].tolist() == [
        [FREE] * 4,
        [FREE, UNKNOWN, OCCUPIED, FREE],
        [OCCUPIED, OCCUPIED, FREE, FREE],
    ]
    assert part.points_of([[1, 1]])[0] == pytest.approx(vast.points_of([[200, 100]])[0])


def test_an_unknown_grid_has_no_frontiers():
    assert find_frontiers(known_part(grid_from_picture("??\n??")), 1.0, 10.0) == []
