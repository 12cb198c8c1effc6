import resource

import numpy as np
import pytest
from PIL import Image

from planar import (
    FREE,
    OCCUPIED,
    UNKNOWN,
    FileWriteError,
    MapFileError,
    Pose2,
    grid_from_picture,
    load_map,
    save_map,
)
from planar.geometry.grid import BandedGrid
from planar.maps.map_file import cells_from_image

GOOD = """image: a.pgm
resolution: 0.05
origin: [-1.0, -2.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


def write(folder, text=GOOD, pixels=((0, 254), (205, 254))):
    Image.fromarray(np.array(pixels, np.uint8)).save(folder / "a.pgm")
    path = folder / "a.yaml"
    path.write_text(text)
    return path


def test_a_saved_map_is_loaded_as_it_was(tmp_path):
    grid = grid_from_picture("#.?\n..#", resolution=0.1, origin=Pose2(-1.0, 2.0, 0.25))
    loaded = load_map(save_map(grid, tmp_path / "home"))
    assert loaded.cells.tolist() == grid.cells.tolist()
    assert (loaded.resolution, loaded.origin) == (grid.resolution, grid.origin)
    assert "image: home.pgm" in (tmp_path / "home.yaml").read_text()


def test_a_banded_map_is_saved_like_the_whole_one(tmp_path):
    whole = grid_from_picture("#.?\n..#\n??.\n.#.", resolution=0.1, origin=Pose2(-1.0, 2.0, 0.25))
    bands = iter([whole.cells[3:], whole.cells[1:3], whole.cells[:1]])
    save_map(whole, tmp_path / "whole")
    save_map(BandedGrid(whole.rows, whole.cols, whole.resolution, whole.origin, bands), tmp_path / "bands")
    assert (tmp_path / "bands.pgm").read_bytes() == (tmp_path / "whole.pgm").read_bytes()
    assert load_map(tmp_path / "bands.yaml").cells.tolist() == whole.cells.tolist()


def test_a_failure_while_saving_bands_keeps_the_old_map(tmp_path):
    def bands():
        yield whole.cells[1:]
        raise KeyboardInterrupt

    whole = grid_from_picture("#.\n.#")
    save_map(whole, tmp_path / "home")
    old = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(KeyboardInterrupt):
        save_map(BandedGrid(2, 2, 1.0, Pose2(), bands()), tmp_path / "home")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == old


def test_shade_205_is_unknown_and_the_first_image_row_is_the_highest(tmp_path):
    assert load_map(write(tmp_path)).cells.tolist() == [[UNKNOWN, FREE], [OCCUPIED, FREE]]


def test_scale_mode_grades_between_the_thresholds(tmp_path):
    grid = load_map(write(tmp_path, GOOD + "mode: scale\n", ((0, 254), (140, 255))))
    assert grid.cells.tolist() == [[56, FREE], [OCCUPIED, FREE]]


def test_raw_mode_keeps_the_pixel_values(tmp_path):
    grid = load_map(write(tmp_path, GOOD + "mode: raw\n", ((0, 100), (255, 7))))
    assert grid.cells.tolist() == [[-1, 7], [0, 100]]


def test_pillow_does_not_warn_of_a_map_that_is_large_but_not_too_large(tmp_path, monkeypatch, recwarn):
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 10)
    Image.new("L", (4, 4)).save(tmp_path / "map.pgm")
    assert cells_from_image(tmp_path / "map.pgm").shape == (4, 4)
    assert not recwarn.list


def test_an_ascii_image_is_read(tmp_path):
    path = write(tmp_path)
    (tmp_path / "a.pgm").write_text("P2\n2 1\n255\n0 254\n")
    assert load_map(path).cells.tolist() == [[OCCUPIED, FREE]]


@pytest.mark.parametrize(
    "before, after, complaint",
    [
        ("resolution: 0.05", "", "resolution is missing"),
        ("resolution: 0.05", "resolution: fine", "resolution must be a number"),
        ("resolution: 0.05", "resolution: -1", "a.yaml:2: resolution must be positive"),
        ("[-1.0, -2.0, 0.0]", "[0, 0]", "origin must be"),
        ("negate: 0", "negate: true", "negate must be 0 or 1"),
        ("image: a.pgm", "image: b.pgm", "b.pgm: no such map image"),
        ("image: a.pgm", "image: a.yaml", "not a readable image"),
        ("negate: 0", "negate: 0\nmode: best", "mode must be one of"),
        ("negate: 0", "negate: [", "not valid YAML"),
    ],
)
def test_a_malformed_map_is_refused_naming_file_line_and_key(tmp_path, before, after, complaint):
    with pytest.raises(MapFileError, match=complaint) as caught:
        load_map(write(tmp_path, GOOD.replace(before, after)))
    assert str(tmp_path) in str(caught.value)


def test_a_failed_save_keeps_the_old_map(tmp_path):
    with pytest.raises(FileWriteError, match="cannot be written"):
        save_map(grid_from_picture("#"), tmp_path / "nowhere" / "home")
    assert list(tmp_path.iterdir()) == []


def test_a_disk_that_is_full_after_the_image_keeps_the_old_pair(tmp_path):
    yaml_path = save_map(grid_from_picture("#"), tmp_path / "home")
    old = [path.read_bytes() for path in sorted(tmp_path.iterdir())]
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (64, limits[1]))  # enough for the image alone
    try:
        with pytest.raises(FileWriteError, match=f"{yaml_path}: cannot be written"):
            save_map(grid_from_picture("."), tmp_path / "home")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert [path.read_bytes() for path in sorted(tmp_path.iterdir())] == old


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:1e\nsize 30\n", "run git lfs pull"),
        (b"<html>", "unknown format"),
    ],
)
def test_an_invalid_image_is_refused_with_the_reason(tmp_path, data, why):
    path = write(tmp_path)
    (tmp_path / "a.pgm").write_bytes(data)
    with pytest.raises(MapFileError, match=why):
        load_map(path)
