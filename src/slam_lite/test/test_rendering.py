import math
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from planar import FREE, OCCUPIED, UNKNOWN, Scan
from slam_lite.rendering import (
    Evidence,
    ScanBeams,
    SessionRenderer,
    beams_of,
    expand_to_extent,
    render_in_bands,
)
from slam_lite.tiles import CellBox, bounding_box


def scan(*ranges, range_max=10.0, **kwargs):
    return Scan(0.0, 0.0, math.pi / 2.0, np.array(ranges, dtype=np.float32), 0.1, range_max, **kwargs)


def drawn(one_scan, max_range=9.99, usable_range=9.99, times=1):
    renderer = SessionRenderer(0.1, 0.25)
    beams = [beams_of(one_scan, max_range, usable_range)] * times
    renderer.update(Evidence(beams, np.zeros((times, 3)) + [0.05, 0.05, 0.0]))
    return renderer.grid()


def test_a_beam_clears_cells_and_marks_its_end():
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


def test_nan_and_zero_are_dropped():
    grid = drawn(scan(1.0, np.nan, 0.0))
    assert grid.value_at(0.05, 1.0) == UNKNOWN
    assert grid.value_at(-1.0, 0.05) == UNKNOWN


def test_a_cell_seen_through_more_often_than_hit_is_free():
    renderer = SessionRenderer(0.1, 0.25)
    beams = [beams_of(scan(2.0 if i == 0 else 3.0), 9.0, 9.0) for i in range(5)]
    renderer.update(Evidence(beams, np.zeros((5, 3)) + [0.05, 0.05, 0.0]))
    assert renderer.grid().value_at(2.05, 0.05) == FREE


def test_a_moved_scan_leaves_nothing_behind():
    beams = [beams_of(scan(2.0, 1.0, 1.5, 3.0), 9.0, 9.0)]
    moved, fresh = SessionRenderer(0.1, 0.25), SessionRenderer(0.1, 0.25)
    pose = np.array([[0.73, -0.41, 0.6]])
    moved.update(Evidence(beams, np.zeros((1, 3))))
    moved.update(Evidence(beams, pose))
    fresh.update(Evidence(beams, pose))
    assert np.array_equal(moved.grid().cells, fresh.grid().cells)
    assert moved.grid().origin == fresh.grid().origin


def test_two_places_far_apart_take_no_memory_in_between():
    renderer = SessionRenderer(0.05, 0.25)
    beams = [beams_of(scan(2.0, 1.0, 1.5, 3.0), 9.0, 9.0)] * 2
    tracemalloc.start()
    renderer.update(Evidence(beams, np.array([[0.0, 0.0, 0.0], [1500.0, 1500.0, 0.0]])))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 10e6  # counts of all cells would take 3.6e9


def test_an_extent_grows_by_ten_metres():
    expanded = expand_to_extent(CellBox(5, -30, 25, -10), (-1.0, -1.0, 1.0, 1.0), 0.1)
    assert (expanded.col, expanded.row) == (-110, -10)
    assert expanded.shape[0] % 32 == 0 and expanded.shape[1] % 32 == 0
    assert bounding_box(expanded, CellBox(5, -30, 25, -10)) == expanded


def test_the_official_extent_has_the_official_size():
    assert expand_to_extent(CellBox(0, 0, 1, 1), (-100.0, -100.0, 100.0, 100.0), 0.05).shape == (4000, 4000)


def test_an_expanded_map_has_the_same_cells():
    renderer = SessionRenderer(0.1, 0.25)
    renderer.update(Evidence([beams_of(scan(2.0, 1.0, 1.5, 3.0), 9.0, 9.0)], np.zeros((1, 3))))
    grid, expanded = renderer.grid(), renderer.grid((-1.0, -1.0, 1.0, 1.0))
    assert (expanded.cells != UNKNOWN).sum() == (grid.cells != UNKNOWN).sum()
    inside = grid.points_of(np.argwhere(grid.cells != UNKNOWN))
    assert [expanded.value_at(*xy) for xy in inside] == [grid.value_at(*xy) for xy in inside]


def evidence_of(keyframes, older, seed, farthest=12.0):
    """Scans at random poses, some without returns."""
    rng = np.random.default_rng(seed)
    angles, beams = np.linspace(-np.pi, np.pi, 60), []
    for _ in range(keyframes):
        ends = np.column_stack((np.cos(angles), np.sin(angles))) * rng.uniform(0.0, farthest, (60, 1))
        count = rng.choice([0, 1, 60])
        beams.append(
            ScanBeams(rng.normal(0.0, 0.1, 2), ends[:count].astype(np.float32), rng.random(count) < 0.7)
        )
    poses = rng.uniform((-9.0, -20.0, -3.0), (9.0, 30.0, 3.0), (keyframes, 3))
    return Evidence(beams, poses, older)


@pytest.mark.parametrize("most_cells", [1, 40_000, 10**9])
@pytest.mark.parametrize("keyframes, older", [(40, 0), (40, 15), (12, 12), (1, 0), (0, 0)])
def test_a_map_in_bands_is_the_map(keyframes, older, most_cells):
    for seed in range(5):
        evidence, renderer = evidence_of(keyframes, older, seed), SessionRenderer(0.05, 0.25)
        renderer.update(evidence)
        whole, banded = renderer.grid(), render_in_bands(evidence, 0.05, 0.25, most_cells)
        bands = list(banded.bands)
        assert all(band.size <= max(most_cells, 64 * banded.cols) for band in bands)
        joined = replace(banded, bands=bands).assemble()
        assert np.array_equal(joined.cells, whole.cells)
        assert (joined.origin, joined.resolution) == (whole.origin, whole.resolution)


def test_a_map_in_bands_never_takes_the_memory_of_all_of_it():
    evidence = evidence_of(400, 0, 0, farthest=30.0)
    size = SessionRenderer(0.02, 0.25)
    size.update(evidence)
    tracemalloc.start()
    cells = sum(band.size for band in render_in_bands(evidence, 0.02, 0.25, 500_000).bands)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert cells == size.grid().cells.size
    assert peak < cells
