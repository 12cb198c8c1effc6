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


SHADES = [0, 100, 205, 254]
TRINARY = [OCCUPIED, UNKNOWN, UNKNOWN, FREE]
HIGH_BYTES = np.array([SHADES], np.uint16) * 257


def cells_of(folder, image, name, **how):
    """Cells of one row; ``image``: a Pillow image, or the bytes of the file."""
    path = folder / name
    if isinstance(image, bytes):
        path.write_bytes(image)
    else:
        image.save(path)
    return cells_from_image(path, **how)[0].tolist()


@pytest.mark.parametrize("name", ["deep.png", "deep.tif"])
def test_an_image_of_16_bits_has_the_shades_of_8(tmp_path, name):
    assert cells_of(tmp_path, Image.fromarray(HIGH_BYTES), name) == TRINARY


def test_pgm_images_of_16_bits_are_scaled(tmp_path):
    pixels = HIGH_BYTES.astype(">u2").tobytes()
    assert cells_of(tmp_path, b"P5\n4 1\n65535\n" + pixels, "deep.pgm") == TRINARY
    assert cells_of(tmp_path, b"P2\n4 1\n65535\n0 25700 52685 65278\n", "deep.pgm") == TRINARY
    assert cells_of(tmp_path, b"P2\n4 1\n1000\n0 393 804 997\n", "deep.pgm") == TRINARY


@pytest.mark.parametrize(
    "header", [b"P5 4 1 254\n", b"P5\n# CREATOR: a camera 1 2 3\n4 # 5\n1\n254\n"], ids=["plain", "commented"]
)
def test_a_pgm_image_up_to_254_is_scaled_down_to_whole_shades(tmp_path, header):
    """205 of 254 is 205.8, of which map_server (SDL_image) makes 205, unknown; 206 would be free."""
    assert cells_of(tmp_path, header + bytes(SHADES), "most_254.pgm") == TRINARY


def test_an_ascii_image_up_to_15_uses_the_full_range(tmp_path):
    assert cells_of(tmp_path, b"P2\n3 1\n15\n0 8 15\n", "most_15.pgm") == [OCCUPIED, UNKNOWN, FREE]


@pytest.mark.parametrize("kind, mode", [(np.float32, "F"), (np.int32, "I")])
def test_images_of_floats_and_32_bits_are_refused(tmp_path, kind, mode):
    image = Image.fromarray(np.array([[0.0, 100.0, 205.0, 254.0]], kind))
    with pytest.raises(MapFileError, match=f"pixels of mode {mode}; expected integers of up to 16 bits"):
        cells_of(tmp_path, image, "floats.tif")


def test_a_portable_float_map_is_refused(tmp_path):
    data = b"Pf\n2 1\n-1.0\n" + np.array([0.0, 1.0], "<f4").tobytes()
    with pytest.raises(MapFileError, match="pixels of mode F"):
        cells_of(tmp_path, data, "floats.pfm")


def test_in_scale_mode_only_what_is_wholly_transparent_is_unknown(tmp_path):
    pixels = np.array([[[170, 170, 170, alpha] for alpha in (255, 128, 1, 0)]], np.uint8)
    how = {"mode": "scale", "occupied_thresh": 0.65, "free_thresh": 0.05}
    assert cells_of(tmp_path, Image.fromarray(pixels), "alpha.png", **how) == [47, 47, 47, UNKNOWN]


def test_raw_mode_rounds_the_mean_of_colours_down(tmp_path):
    pixels = np.array([[[100, 101, 101], [7, 7, 8]]], np.uint8)
    assert cells_of(tmp_path, Image.fromarray(pixels), "colours.png", mode="raw") == [100, 7]


def test_colours_of_a_palette_count_not_their_numbers(tmp_path):
    grey = Image.fromarray(np.array([SHADES], np.uint8))
    assert cells_of(tmp_path, grey.convert("RGB").convert("P"), "palette.png")[::3] == [OCCUPIED, FREE]
    assert cells_of(tmp_path, grey.convert("1", dither=Image.Dither.NONE), "bits.png")[::3] == [
        OCCUPIED,
        FREE,
    ]
    assert cells_of(tmp_path, b"P4\n4 1\n\x80", "bits.pbm") == [OCCUPIED, FREE, FREE, FREE]
