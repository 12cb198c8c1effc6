"""Map files: the YAML and image pair of map_server (interface of ROS 1 navigation 1.17)."""

import io
import re
from pathlib import Path
from typing import Any, Iterator, Tuple, Union

import numpy as np

from planar.config.yaml_table import read_table
from planar.errors import PlanarError
from planar.files.reading import read_bytes
from planar.files.writing import write_all_atomically
from planar.geometry.grid import FREE, OCCUPIED, UNKNOWN, BandedGrid, OccupancyGrid
from planar.geometry.limits import MAX_RESOLUTION, MIN_RESOLUTION
from planar.geometry.pose import Pose2

MODES = ("trinary", "scale", "raw")
MAX_PIXELS = 100_000_000
# Header of a PNM image; the group is the maximum of its values.
PNM_HEADER = re.compile(rb"P[2356](?:(?:\s|#[^\n]*\n)+\d+){2}(?:\s|#[^\n]*\n)+(\d+)")
# First bytes of a Git LFS pointer file.
LFS_POINTER = b"version https://git-lfs"


class MapFileError(PlanarError):
    """A map file cannot be read or written; the text names the file and the key."""


class MapMissingError(MapFileError):
    """The map file does not exist."""


class MapImageError(MapFileError):
    """The image of a map is missing or cannot be read."""


class MapDescriptionError(MapFileError):
    """The YAML file of a map is invalid."""


def load_map(path) -> OccupancyGrid:
    """Load the map that a map_server YAML file describes.

    Raises:
        MapFileError: If the YAML file or the image is missing or invalid.
    """
    path = Path(path)
    table = read_table(path, error=MapDescriptionError, missing=MapMissingError)
    resolution = table.number("resolution")
    table.check(resolution > 0.0, "resolution", "positive")
    of_use = f"from {MIN_RESOLUTION:g} to {MAX_RESOLUTION:g}"
    table.check(MIN_RESOLUTION <= resolution <= MAX_RESOLUTION, "resolution", of_use)
    mode = table.choice("mode", MODES, "trinary")
    negate = table.value("negate")
    table.check(negate in (0, 1) and not isinstance(negate, bool), "negate", "0 or 1")
    cells = cells_from_image(
        path.parent / table.text("image"),
        negate=bool(negate),
        occupied_thresh=table.number("occupied_thresh"),
        free_thresh=table.number("free_thresh"),
        mode=mode,
    )
    origin = Pose2(*table.numbers("origin", "x, y, yaw"))
    table.check(origin.is_in_range(), "origin", "finite and within range")
    return OccupancyGrid(cells, resolution, origin)


def cells_from_image(
    image_path, negate=False, occupied_thresh=0.65, free_thresh=0.196, mode="trinary"
) -> np.ndarray:
    """Convert a map image to occupancy as map_server does.

    Args:
        image_path: Image in any format of Pillow.
        negate: Whether white is occupied.
        occupied_thresh: Occupancy above which a cell is occupied, 0 to 1.
        free_thresh: Occupancy below which a cell is free, 0 to 1.
        mode: ``trinary``, ``scale`` or ``raw``.

    Returns:
        Cells, int8 (rows, cols), row 0 lowest.

    Raises:
        MapImageError: If the image cannot be read.
    """
    pixels = _pixels(image_path)
    channels = pixels if mode == "trinary" else pixels[:, :, :3]  # trinary: alpha is averaged in
    sums = np.flipud(channels.sum(axis=2, dtype=np.uint16))
    # A table over the possible sums, which are far fewer than the pixels.
    shade = np.arange(255 * channels.shape[2] + 1) / channels.shape[2]
    if negate:
        shade = 255.0 - shade
    if mode == "raw":
        return shade.astype(np.uint8).astype(np.int8)[sums]
    occupancy = (255.0 - shade) / 255.0
    meaning = np.full(occupancy.shape, UNKNOWN, dtype=np.int8)
    if mode == "scale" and occupied_thresh > free_thresh:
        between = 1.0 + 98.0 * (occupancy - free_thresh) / (occupied_thresh - free_thresh)
        meaning = np.clip(between, 1.0, 99.0).astype(np.int8)
    is_certain = (occupancy > occupied_thresh) | (occupancy < free_thresh)
    meaning[occupancy > occupied_thresh] = OCCUPIED
    meaning[occupancy < free_thresh] = FREE
    cells = meaning[sums]
    if mode == "scale" and pixels.shape[2] == 4:
        cells[(np.flipud(pixels[:, :, 3]) == 0) & ~is_certain[sums]] = UNKNOWN
    return cells


def _pixels(image_path) -> np.ndarray:
    """Return the pixels of an image, uint8 (rows, cols, 3), or (rows, cols, 4) with transparency."""
    from PIL import Image, UnidentifiedImageError  # imported late: writing maps does not need it

    Image.MAX_IMAGE_PIXELS = None  # its own limit is lower than MAX_PIXELS
    try:
        data = read_bytes(image_path)
        if data.startswith(LFS_POINTER):
            raise ValueError("a Git LFS pointer; run git lfs pull to get the image")
        data, pnm_maximum = _with_full_range(data)
        with Image.open(io.BytesIO(data)) as image:
            if image.width * image.height > MAX_PIXELS:
                raise ValueError(f"{image.width} x {image.height} pixels exceed the limit of {MAX_PIXELS}")
            if len(image.getbands()) == 1 and image.mode not in ("1", "L", "P"):
                return np.repeat(_shades(image)[:, :, None], 3, axis=2)
            pixels = np.asarray(image.convert("RGBA" if "A" in image.getbands() else "RGB"))
        return pixels if pnm_maximum == 255 else _scaled(pixels, pnm_maximum)
    except FileNotFoundError:
        raise MapImageError(f"{image_path}: no such map image") from None
    except UnidentifiedImageError:
        raise MapImageError(f"{image_path}: not a readable image (unknown format)") from None
    except Exception as error:  # errors of Pillow's readers have no common class
        raise MapImageError(f"{image_path}: not a readable image ({error})") from None


def _with_full_range(data: bytes) -> Tuple[bytes, int]:
    """Declare 255 as the maximum of a PNM image with less, which Pillow would round when it scales.

    Args:
        data: Image file.

    Returns:
        The file, and the maximum of its values; 255 for all other images.
    """
    header = PNM_HEADER.match(data)
    maximum = int(header.group(1)) if header else 255
    if header is None or not 0 < maximum < 255:
        return data, 255
    return data[: header.start(1)] + b"255" + data[header.end(1) :], maximum


def _shades(image: Any) -> np.ndarray:
    """Return the pixels of a grey image of more than 8 bits, scaled to uint8 (rows, cols).

    Raises:
        ValueError: The pixels are not of 16 bits.
    """
    values = np.asarray(image)
    is_16_bit = image.mode.startswith("I;16") or (image.mode == "I" and image.format in ("PNG", "PPM"))
    if not is_16_bit or values.min() < 0 or values.max() > 0xFFFF:
        raise ValueError(f"pixels of mode {image.mode}; expected integers of up to 16 bits")
    if image.format == "PNG":  # SDL_image uses the high byte of PNG, and scales TIFF
        return (values.astype(np.uint32) >> 8).astype(np.uint8)
    return _scaled(values, 0xFFFF)


def _scaled(values: np.ndarray, maximum: int) -> np.ndarray:
    """Scale values from 0 to a maximum to uint8, rounding down as SDL_image does."""
    return (np.minimum(values, maximum).astype(np.uint32) * 255 // maximum).astype(np.uint8)


def save_map(grid: Union[OccupancyGrid, BandedGrid], stem, occupied_at: int = 65, free_at: int = 25) -> Path:
    """Write ``stem``.pgm and ``stem``.yaml as map_saver does, both or none.

    The YAML names the image without a folder, so that the pair can be moved.

    Args:
        grid: Map.
        stem: Path without extension.
        occupied_at: Cells from this value to 100 become occupied.
        free_at: Cells from 0 to this value become free; all others become unknown.

    Returns:
        Path of the YAML file.

    Raises:
        FileWriteError: If they cannot be written.
    """
    stem = Path(stem)
    pgm_path, yaml_path = stem.with_name(stem.name + ".pgm"), stem.with_name(stem.name + ".yaml")
    description = (
        f"image: {pgm_path.name}\n"
        f"resolution: {grid.resolution:f}\n"
        f"origin: [{grid.origin.x:f}, {grid.origin.y:f}, {grid.origin.yaw:f}]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n\n"
    )
    bands = grid.in_bands if isinstance(grid, OccupancyGrid) else grid
    write_all_atomically(
        {pgm_path: _pgm(bands, occupied_at, free_at), yaml_path: [description.encode("ascii")]}
    )
    return yaml_path


def _pgm(grid: BandedGrid, occupied_at: int, free_at: int) -> Iterator[bytes]:
    """Yield the image row by row, since large maps have many millions of pixels."""
    shades = np.full(256, 205, dtype=np.uint8)  # index: byte of a cell; negative values start at 128
    shades[: free_at + 1] = 254
    shades[occupied_at:128] = 0
    yield f"P5\n# {grid.resolution:.3f} m/pix\n{grid.cols} {grid.rows}\n255\n".encode("ascii")
    for rows in map(_rows, grid.bands):  # holds one band at a time
        yield from (row.translate(shades.tobytes()) for row in rows)


def _rows(cells: np.ndarray) -> Iterator[bytes]:
    """Yield the bytes of the rows from the top."""
    for row in np.flipud(cells):
        yield row.tobytes()
