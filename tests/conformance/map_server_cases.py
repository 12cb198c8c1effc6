"""Statements of map_server 1.17: its source and https://wiki.ros.org/map_server.

The input of a case is of a ``kind``: an image (``files``), a run of map_server (``files``, ``arguments``,
``parameters``, ``changes``), or a run of map_saver (``data``, ``width``, ``quaternion``, ``arguments``).
"""

import io
from typing import Any, List, Sequence

import numpy as np
from case import SAME, Case, Rig
from map_server_rig import run_official, run_ours
from PIL import Image

LOADER, MAIN, SAVER = (
    "map_server/src/image_loader.cpp",
    "map_server/src/main.cpp",
    "map_server/src/map_saver.cpp",
)
WIKI = "https://wiki.ros.org/map_server#YAML_format"
SHADES = (0, 100, 205, 254)
DEEP = np.array([SHADES], np.uint16) * 257
TRINARY = [100, -1, -1, 0]
YAML = {
    "image": "map.pgm",
    "resolution": "0.05",
    "origin": "[-1.0, -2.0, 0.0]",
    "negate": "0",
    "occupied_thresh": "0.65",
    "free_thresh": "0.196",
}
PALETTE = "a palette's numbers are no shades: all such pixels became occupied"


def description(**changed: Any) -> str:
    """A map's YAML file; a value of None leaves its key out."""
    values = {**YAML, **changed}
    return "".join(f"{key}: {value}\n" for key, value in values.items() if value is not None)


def file_of(pixels: Any, kind: str, mode: str = "") -> List[int]:
    """The bytes of an image file."""
    image = pixels if isinstance(pixels, Image.Image) else Image.fromarray(np.array(pixels))
    file = io.BytesIO()
    (image.convert(mode) if mode else image).save(file, kind)
    return list(file.getvalue())


def pgm(values: Sequence[int] = SHADES, maximum: int = 255, rows: int = 1, magic: str = "P5") -> List[int]:
    """The bytes of a PGM file."""
    header = f"{magic}\n# of a test\n{len(values) // rows} {rows}\n{maximum}\n".encode()
    body = bytes(values) if magic == "P5" else " ".join(map(str, values)).encode() + b"\n"
    return list(header + body)


def image(
    name: str, source: str, file: List[int], expected: Any, official: Any = SAME, reason: str = "", **yaml
):
    """A case of an image, whose cells are expected from the lowest row on, or "refused"."""
    given = {"kind": "image", "files": {"map.pgm": file, "map.yaml": list(description(**yaml).encode())}}
    return Case(name, source, "map_server", given, expected, official, reason)


def server(
    name: str, source: str, fact: str, expected: Any, official: Any = SAME, reason: str = "", **given: Any
):
    """A case of a run of map_server; ``fact``: path in what observe_map_server reports (facts.py)."""
    files = {"map.pgm": pgm(), "map.yaml": list(description(**given.pop("yaml", {})).encode())}
    files.update(given.pop("files", {}))
    arguments = given.pop("arguments", ["map.yaml"])
    given = {"kind": "server", "files": files, "arguments": arguments, "fact": fact, **given}
    return Case(name, source, "map_server", given, expected, official, reason)


def saver(name: str, fact: str, expected: Any, official: Any = SAME, reason: str = "", **given: Any):
    """A case of a run of map_saver; ``fact`` as in ``server``."""
    return Case(
        name, SAVER, "map_server", {"kind": "saver", "fact": fact, **given}, expected, official, reason
    )


def rgba(*alphas: int, shade: int = 170) -> List[int]:
    """A PNG of one row of a shade with these alphas."""
    return file_of(np.array([[[shade, shade, shade, alpha] for alpha in alphas]], np.uint8), "PNG")


def palette() -> List[int]:
    """A PNG of the shades as numbers 0 to 3 of a palette."""
    numbered = Image.fromarray(np.array([[0, 1, 2, 3]], np.uint8), "P")
    numbered.putpalette([channel for shade in SHADES for channel in (shade, shade, shade)])
    return file_of(numbered, "PNG")


GREY = file_of(np.array([SHADES], np.uint8), "PNG")
SCALE = {"mode": "scale", "free_thresh": "0.05"}

IMAGES = [
    image("cells_above_occupied_thresh_are_100_and_below_free_thresh_0", WIKI, pgm(), TRINARY),
    image(
        "the_first_row_of_the_image_is_the_highest", LOADER, pgm((0, 0, 254, 254), rows=2), [0, 0, 100, 100]
    ),
    image("negate_makes_white_occupied", WIKI, pgm((0, 255)), [0, 100], negate=1),
    image(
        "the_thresholds_themselves_are_unknown",
        LOADER,
        pgm((51, 204)),
        [-1, -1],
        occupied_thresh=0.8,
        free_thresh=0.2,
    ),
    image("an_ascii_image_is_read", LOADER, pgm(magic="P2"), TRINARY),
    image("a_png_image_is_read", WIKI, GREY, TRINARY),
    image(
        "a_colour_counts_by_the_mean_of_its_channels",
        LOADER,
        file_of(np.array([[[0, 0, 255], [255, 255, 200]]], np.uint8), "PNG"),
        [100, 0],
    ),
    image("alpha_is_averaged_in_in_trinary_mode", LOADER, rgba(0, 255, shade=100), [100, -1]),
    image("a_png_of_16_bits_counts_by_its_high_byte", LOADER, file_of(Image.fromarray(DEEP), "PNG"), TRINARY),
    image(
        "a_tiff_of_16_bits_is_scaled",
        LOADER,
        file_of(Image.fromarray(DEEP), "TIFF"),
        TRINARY,
        [100, -1, 0, 0],
        "the opaque alpha that the reader of TIFF adds is averaged in: unknown becomes free",
    ),
    image(
        "a_grey_tiff_is_read_as_a_png",
        LOADER,
        file_of(np.array([SHADES], np.uint8), "TIFF"),
        TRINARY,
        [100, -1, 0, 0],
        "the opaque alpha that the reader of TIFF adds is averaged in: unknown becomes free",
    ),
    image(
        "a_pgm_of_16_bits_is_scaled",
        LOADER,
        list(b"P5\n4 1\n65535\n" + DEEP.astype(">u2").tobytes()),
        TRINARY,
        "refused",
        "its shades are known as well as those of a PNG",
    ),
    image("a_pgm_up_to_254_is_scaled_rounding_down", LOADER, pgm(maximum=254), TRINARY),
    image("an_ascii_pgm_up_to_15_is_scaled", LOADER, pgm((0, 8, 15), 15, magic="P2"), [100, -1, 0]),
    image(
        "an_image_of_floats_is_refused",
        LOADER,
        file_of(Image.fromarray(np.array([[0.0, 254.0]], np.float32)), "TIFF"),
        "refused",
    ),
    image("an_unknown_format_is_refused", LOADER, list(b"<html>"), "refused"),
    image("a_palette_counts_by_its_colours", LOADER, palette(), TRINARY, [100, 100, 100, 100], PALETTE),
    image(
        "a_bitmap_of_one_bit_counts_by_its_colours",
        LOADER,
        list(b"P4\n4 1\n\x80"),
        [100, 0, 0, 0],
        [100, 100, 100, 100],
        PALETTE,
    ),
    image(
        "a_png_of_one_bit_counts_by_its_colours",
        LOADER,
        file_of(np.array([[0, 255]], np.uint8), "PNG", "1"),
        [100, 0],
    ),
    image(
        "scale_grades_from_1_to_99_between_the_thresholds", WIKI, pgm((230, 170, 110)), [8, 47, 85], **SCALE
    ),
    image("scale_keeps_0_and_100_outside_of_the_thresholds", WIKI, pgm((0, 254)), [100, 0], **SCALE),
    image("scale_makes_only_alpha_0_unknown", LOADER, rgba(255, 128, 1, 0), [47, 47, 47, -1], **SCALE),
    image(
        "scale_takes_an_image_without_alpha_as_opaque",
        LOADER,
        file_of(np.array([[[170, 170, 0], [170, 170, 170]]], np.uint8), "PNG"),
        [83, 47],
        [-1, 47],
        "the last colour is taken for alpha, so that all without blue becomes unknown",
        **SCALE,
    ),
    image("scale_does_not_average_alpha", LOADER, rgba(1, 255), [47, 47], **SCALE),
    image("raw_keeps_the_values", WIKI, pgm((0, 1, 100, 127)), [0, 1, 100, 127], mode="raw"),
    image("raw_has_255_as_unknown", LOADER, pgm((255, 128)), [-1, -128], mode="raw"),
    image(
        "raw_rounds_the_mean_down",
        LOADER,
        file_of(np.array([[[100, 101, 101]]], np.uint8), "PNG"),
        [100],
        mode="raw",
    ),
    image("raw_is_negated", LOADER, pgm((0, 255, 155)), [-1, 0, 100], mode="raw", negate=1),
    image("a_mode_of_another_name_is_refused", MAIN, pgm(), "refused", mode="binary"),
    image("without_a_mode_trinary_is_used", MAIN, pgm((120,)), [-1]),
    image("a_map_without_resolution_is_refused", MAIN, pgm(), "refused", resolution=None),
    image("a_map_without_negate_is_refused", MAIN, pgm(), "refused", negate=None),
    image("a_map_without_occupied_thresh_is_refused", MAIN, pgm(), "refused", occupied_thresh=None),
    image("a_map_without_free_thresh_is_refused", MAIN, pgm(), "refused", free_thresh=None),
    image("a_map_without_origin_is_refused", MAIN, pgm(), "refused", origin=None),
    image("a_map_without_image_is_refused", MAIN, pgm(), "refused", image=None),
    image("an_empty_image_is_refused", MAIN, pgm(), "refused", image='""'),
    image("a_missing_image_is_refused", MAIN, pgm(), "refused", image="other.pgm"),
    image("keys_of_other_programs_are_ignored", MAIN, pgm(), TRINARY, image_size="[4, 1]"),
]

SERVER = [
    server("the_map_is_published_latched", MAIN, "map.data", TRINARY),
    server("the_frame_is_map", WIKI, "map.frame", "map"),
    server("the_frame_is_that_of_frame_id", WIKI, "map.frame", "home", parameters={"frame_id": "home"}),
    server("the_map_is_stamped", MAIN, "map.has_stamp", True),
    server("map_load_time_is_set", MAIN, "map.has_load_time", True),
    server("the_size_is_columns_by_rows", MAIN, "map.size", [4, 1]),
    server("the_resolution_is_that_of_the_file", WIKI, "map.resolution", 0.05),
    server(
        "the_yaw_of_origin_is_published",
        LOADER,
        "map.origin",
        [-1.0, 2.0, 0.7],
        yaml={"origin": "[-1.0, 2.0, 0.7]"},
    ),
    server("the_metadata_are_published_latched", MAIN, "metadata", [4, 1, 0.05]),
    server("static_map_returns_the_map", MAIN, "static_map.data", TRINARY),
    server(
        "the_topics_are_map_and_map_metadata",
        MAIN,
        "topics",
        {"/map": "nav_msgs/OccupancyGrid", "/map_metadata": "nav_msgs/MapMetaData"},
    ),
    server("the_services_are_static_map_and_change_map", MAIN, "services", ["/change_map", "/static_map"]),
    server(
        "change_map_loads_another_map",
        MAIN,
        "changes.0.2",
        [0, 0],
        changes=["FOLDER/other.yaml"],
        files={"other.yaml": list(description(image="other.pgm").encode()), "other.pgm": pgm((254, 254))},
    ),
    server(
        "change_map_keeps_the_map_if_the_other_is_missing",
        MAIN,
        "changes.0",
        [False, [], TRINARY],
        changes=["FOLDER/nowhere.yaml"],
    ),
    server(
        "change_map_returns_the_map",
        "nav_msgs/srv/LoadMap.srv",
        "changes.0.1",
        [0, 0],
        [],
        "by the service's definition the map is only valid on success; the official answer has none",
        changes=["FOLDER/other.yaml"],
        files={"other.yaml": list(description(image="other.pgm").encode()), "other.pgm": pgm((254, 254))},
    ),
    server(
        "a_missing_file_ends_the_node",
        MAIN,
        "exit_code",
        2,
        255,
        "2 is the code of wrong input in this workspace",
        arguments=["nowhere.yaml"],
    ),
    server("the_size_is_logged", MAIN, "log has Read a 4 X 1 map @ 0.05", True),
    server(
        "an_image_with_a_resolution_is_deprecated",
        MAIN,
        "log has deprecated",
        True,
        arguments=["map.pgm", "0.1"],
    ),
    server("an_image_with_a_resolution_is_a_map", MAIN, "map.resolution", 0.1, arguments=["map.pgm", "0.1"]),
    server(
        "an_image_with_a_resolution_lies_at_the_origin",
        MAIN,
        "map.origin",
        [0.0, 0.0, 0.0],
        arguments=["map.pgm", "0.1"],
    ),
    server(
        "an_image_with_a_resolution_is_read_by_the_parameter_negate",
        MAIN,
        "map.data",
        [0, -1, 100, 100],
        arguments=["map.pgm", "0.1"],
        parameters={"negate": 1},
    ),
    server(
        "an_image_with_a_resolution_is_read_by_the_parameters_of_thresholds",
        MAIN,
        "map.data",
        [100, 100, 0, 0],
        arguments=["map.pgm", "0.1"],
        parameters={"occupied_thresh": 0.6, "free_thresh": 0.3},
    ),
    server(
        "a_resolution_that_is_no_number_counts_as_none",
        MAIN,
        "map.resolution",
        0.05,
        arguments=["map.yaml", "fine"],
    ),
    server(
        "too_many_arguments_end_the_node",
        MAIN,
        "exit_code",
        2,
        255,
        "2 is the code of wrong input in this workspace",
        arguments=["map.yaml", "0.1", "more"],
    ),
]

HALF_TURN = [0.0, 0.0, 1.0, 0.0]
SAVED = (
    "image: map.pgm\nresolution: 0.500000\norigin: [-1.000000, 2.000000, 0.000000]\n"
    "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n\n"
)
SAVER_CASES = [
    saver("free_occupied_and_unknown_are_254_0_and_205", "pixels", [254, 0, 205, 205]),
    saver(
        "values_up_to_25_are_free_and_from_65_occupied", "pixels", [254, 205, 205, 0], data=[25, 26, 64, 65]
    ),
    saver(
        "occ_and_free_set_the_limits",
        "pixels",
        [254, 205, 0, 0],
        data=[10, 11, 50, 51],
        arguments=["--occ", "50", "--free", "10"],
    ),
    saver(
        "the_lowest_row_of_the_map_is_the_last_of_the_image",
        "pixels",
        [0, 0, 254, 254],
        width=2,
        data=[0, 0, 100, 100],
    ),
    saver("the_image_is_a_binary_pgm", "magic", "P5"),
    saver("the_description_has_all_keys", "yaml", SAVED),
    saver("f_names_the_files", "files has home.pgm", True, arguments=["-f", "home"]),
    saver("without_f_the_files_are_map", "files has map.yaml", True),
    saver("the_yaw_of_the_origin_is_saved", "yaml has 3.141593", True, quaternion=HALF_TURN),
    saver(
        "a_quaternion_of_zeros_is_no_rotation",
        "yaml",
        SAVED,
        SAVED.replace("0.000000]", "-nan]"),
        "map_server refuses a file with -nan",
        quaternion=[0.0, 0.0, 0.0, 0.0],
    ),
    saver("a_saved_map_ends_the_node", "exit_code", 0),
    saver("occ_has_to_be_above_free", "exit_code", 1, arguments=["--occ", "20", "--free", "30"]),
    saver("occ_above_100_is_refused", "exit_code", 1, arguments=["--occ", "101"]),
    saver("free_below_0_is_refused", "exit_code", 1, arguments=["--free", "-1"]),
    saver("occ_of_0_is_refused", "exit_code", 1, arguments=["--occ", "0"]),
    saver("an_unknown_option_is_refused", "exit_code", 1, arguments=["--nonsense"]),
    saver("h_prints_the_usage", "exit_code", 0, arguments=["-h"]),
    saver("the_size_is_logged", "log has Received a 4 X 1 map @ 0.500 m/pix", True),
    saver(
        "the_description_names_the_image_beside_it",
        "yaml has image: home.pgm",
        True,
        False,
        "the path as given to -f is relative to another folder: the pair could not be loaded",
        arguments=["-f", "./home"],
    ),
]

CASES = IMAGES + SERVER + SAVER_CASES
RIGS = {"map_server": Rig(run_ours, run_official, ("map_server/map_server", "map_server/map_saver"))}
