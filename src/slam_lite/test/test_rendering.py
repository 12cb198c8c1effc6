import math
import tracemalloc

import numpy as np

from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, Pose2, Scan
from slam_lite.rendering import MapRenderer, beams_of, on_canvas


def scan(*ranges, range_max=10.0, **kwargs):
    return Scan(0.0, 0.0, math.pi / 2.0, np.array(ranges, dtype=np.float32), 0.1, range_max, **kwargs)


def drawn(one_scan, max_range=9.99, usable_range=9.99, times=1):
    renderer = MapRenderer(0.1, 0.25)
    beams = [beams_of(one_scan, max_range, usable_range)] * times
    renderer.update(beams, np.zeros((times, 3)) + [0.05, 0.05, 0.0])
    return renderer.grid()


def test_a_beam_clears_its_way_and_marks_its_end():
    grid = drawn(scan(2.0))
    assert grid.value_at(1.0, 0.05) == FREE
    assert grid.value_at(2.05, 0.05) == OCCUPIED
    assert grid.value_at(2.25, 0.05) == UNKNOWN


def test_readings_above_max_range_neither_clear_nor_mark():
    grid = drawn(scan(2.0, 5.0), max_range=3.0, usable_range=3.0)
    assert grid.value_at(0.05, 1.0) == UNKNOWN


def test_readings_between_usable_and_max_range_clear_and_mark_nothing():
    grid = drawn(scan(1.0, 5.0), max_range=9.0, usable_range=3.0)
    assert grid.value_at(0.05, 2.5) == FREE
    assert grid.value_at(0.05, 3.5) == UNKNOWN
    assert not np.any(grid.cells[round((0.5 - grid.origin.y) / 0.1) :] == OCCUPIED)


def test_no_return_clears_if_max_range_reaches_the_sensors():
    assert drawn(scan(1.0, np.inf), max_range=10.0, usable_range=4.0).value_at(0.05, 3.5) == FREE
    assert drawn(scan(1.0, np.inf)).value_at(0.05, 3.5) == UNKNOWN


def test_nan_and_zero_say_nothing():
    grid = drawn(scan(1.0, np.nan, 0.0))
    assert grid.value_at(0.05, 1.0) == UNKNOWN
    assert grid.value_at(-1.0, 0.05) == UNKNOWN


def test_a_cell_seen_through_more_often_than_hit_is_free():
    renderer = MapRenderer(0.1, 0.25)
    beams = [beams_of(scan(2.0 if i == 0 else 3.0), 9.0, 9.0) for i in range(5)]
    renderer.update(beams, np.zeros((5, 3)) + [0.05, 0.05, 0.0])
    assert renderer.grid().value_at(2.05, 0.05) == FREE


def test_a_moved_scan_leaves_nothing_behind():
    beams = [beams_of(scan(2.0, 1.0, 1.5, 3.0), 9.0, 9.0)]
    moved, fresh = MapRenderer(0.1, 0.25), MapRenderer(0.1, 0.25)
    pose = np.array([[0.73, -0.41, 0.6]])
    moved.update(beams, np.zeros((1, 3)))
    moved.update(beams, pose)
    fresh.update(beams, pose)
    assert np.array_equal(moved.grid().cells, fresh.grid().cells)
    assert moved.grid().origin == fresh.grid().origin


def test_two_places_far_apart_take_no_memory_for_what_lies_between():
    renderer = MapRenderer(0.05, 0.25)
    beams = [beams_of(scan(2.0, 1.0, 1.5, 3.0), 9.0, 9.0)] * 2
    tracemalloc.start()
    renderer.update(beams, np.array([[0.0, 0.0, 0.0], [1500.0, 1500.0, 0.0]]))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 10e6  # counts of all cells would take 3.6e9


def test_a_canvas_is_as_large_as_asked_and_grows_by_ten_metres():
    grid = OccupancyGrid(np.zeros((20, 20), dtype=np.int8), 0.1, Pose2(-3.0, 0.5, 0.0))
    canvas = on_canvas(grid, (-1.0, -1.0, 1.0, 1.0))
    assert (canvas.origin.x, canvas.origin.y) == (-11.0, -1.0)
    assert canvas.cols % 32 == 0 and canvas.rows % 32 == 0
    assert canvas.value_at(-2.0, 1.5) == FREE
    assert (canvas.cells == FREE).sum() == grid.cells.size


def test_the_official_canvas_has_the_official_size():
    canvas = on_canvas(OccupancyGrid(np.zeros((1, 1), dtype=np.int8), 0.05), (-100.0, -100.0, 100.0, 100.0))
    assert canvas.cells.shape == (4000, 4000)
