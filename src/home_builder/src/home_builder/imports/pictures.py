"""Plans from pictures of floor plans, with a scale."""

import math
from pathlib import Path
from typing import Callable, Tuple

import numpy as np
from scipy.ndimage import binary_closing, binary_dilation, binary_opening

from home_builder.errors import ImportPlanError
from home_builder.imports.joints import join_walls, rounded
from home_builder.imports.maps import start_of
from home_builder.imports.outlines import furniture_from_cells
from home_builder.imports.wall_strips import SolidCells, straight_walls
from home_builder.plan.model import DOOR, WINDOW, HomePlan, Point
from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, Pose2
from planar.files.reading import read_bytes

# Largest picture [pixels], and the size of a cell to which finer ones are reduced [m].
MAX_PIXELS, CELL = 60_000_000, 0.025
# Scales that a floor plan can have [m per pixel].
SCALES = (0.0005, 0.5)
# Thinnest wall: thinner strokes are text, dimensions, doors and windows as drawn [m].
MIN_WALL = 0.06
# Smallest piece that counts as furniture [m2]: smaller ones are text.
MIN_PIECE = 0.04
# Grey below which a pixel is dark, if the picture has no clear threshold; greatest share of walls.
MOST_DARK = 0.6
# Share of a gap's length at which a window is drawn in it.
WINDOW_SHARE = 0.8


def import_picture(path: Path, scale: float) -> HomePlan:
    """Make a plan of a picture in which walls are darker than the floor.

    Args:
        path: Picture in a format of Pillow.
        scale: Size of a pixel [m].

    Returns:
        The plan; its origin is the lower left corner of the picture.

    Raises:
        ImportPlanError: The picture cannot be read, or shows no plan.
    """
    if not SCALES[0] <= scale <= SCALES[1]:
        raise ImportPlanError(
            f"--scale: must be the size of a pixel, {SCALES[0]:g} to {SCALES[1]:g} m, got {scale:g}"
        )
    ink = _dark(_shades(path), path)
    ink, cell = _reduced(ink, scale)
    side = max(1, int(round(MIN_WALL / cell)))
    strong = binary_opening(ink, np.ones((side, side), dtype=bool))
    walls_cells = strong if strong.any() else ink  # a plan of thin lines
    strips, rest = straight_walls(SolidCells(walls_cells, cell))
    walls = join_walls(strips, cell, _gaps_in(ink, cell))
    if not walls:
        raise ImportPlanError(f"{path}: no straight walls were found; walls must be darker than the floor")
    furniture = [
        piece
        for piece in furniture_from_cells(SolidCells(rest, cell))
        if piece.size[0] * piece.size[1] >= MIN_PIECE
    ]
    start = start_of(_grid(walls_cells, cell), (0.0, 0.0), str(path))
    return HomePlan(path.stem, tuple(map(rounded, walls)), tuple(furniture), start=start)


def _shades(path: Path) -> np.ndarray:
    """Return the grey values of a picture, transparency as white, uint8 (rows, cols), row 0 lowest."""
    import io

    from PIL import Image, ImageOps, UnidentifiedImageError

    Image.MAX_IMAGE_PIXELS = None  # the limit here is stated in the message
    try:
        with Image.open(io.BytesIO(read_bytes(path))) as image:
            if image.width * image.height > MAX_PIXELS:
                size = f"{image.width} x {image.height}"
                most = f"{MAX_PIXELS // 1_000_000} million"
                raise ImportPlanError(f"{path}: {size} pixels are more than {most}; reduce the picture")
            upright = ImageOps.exif_transpose(image) or image
            opaque = Image.new("RGBA", upright.size, "white")
            opaque.alpha_composite(upright.convert("RGBA"))
            return np.flipud(np.asarray(opaque.convert("L")))
    except FileNotFoundError:
        raise ImportPlanError(f"{path}: no such file") from None
    except UnidentifiedImageError:
        raise ImportPlanError(f"{path}: not a readable picture (unknown format)") from None
    except ImportPlanError:
        raise
    except Exception as error:  # errors of Pillow's readers have no common class
        raise ImportPlanError(f"{path}: not a readable picture ({error})") from None


def _dark(shades: np.ndarray, path: Path) -> np.ndarray:
    """Return the dark pixels, by the threshold that separates dark and light best (Otsu, 1979)."""
    counts = np.bincount(shades.ravel(), minlength=256).astype(float)
    levels = np.arange(256)
    below, total = np.cumsum(counts), counts.sum()
    sums = np.cumsum(counts * levels)
    with np.errstate(divide="ignore", invalid="ignore"):
        between = (sums[-1] * below / total - sums) ** 2 / (below * (total - below))
    threshold = int(np.nanargmax(np.where(np.isfinite(between), between, -1.0)))
    dark = shades <= threshold
    if not np.isfinite(between).any() or np.ptp(shades) < 32:
        raise ImportPlanError(f"{path}: shows no plan, as all of it has about the same brightness")
    if dark.mean() > MOST_DARK:
        share = f"{dark.mean():.0%}"
        raise ImportPlanError(
            f"{path}: {share} of it are dark; walls must be darker than the floor: invert the picture"
        )
    return dark


def _reduced(ink: np.ndarray, scale: float) -> Tuple[np.ndarray, float]:
    """Return the picture with cells of about CELL, a cell being dark if half of it is, and their size."""
    factor = int(CELL / scale)
    if factor < 2:
        return ink, scale
    rows, cols = (side // factor * factor for side in ink.shape)
    blocks = ink[:rows, :cols].reshape(rows // factor, factor, cols // factor, factor)
    return blocks.mean(axis=(1, 3)) >= 0.5, scale * factor


def _grid(walls: np.ndarray, cell: float) -> OccupancyGrid:
    """Return a map in which all that walls enclose is free, and what lies outside is unknown."""
    from scipy.ndimage import binary_fill_holes

    margin = max(1, int(1.5 / cell))
    padded = np.pad(walls, margin)
    side = int(1.5 / cell)
    closed = binary_closing(padded, np.ones((1, side))) | binary_closing(padded, np.ones((side, 1)))
    inside = binary_fill_holes(closed)[margin:-margin, margin:-margin]
    cells = np.where(walls, OCCUPIED, np.where(inside, FREE, UNKNOWN)).astype(np.int8)
    return OccupancyGrid(cells, cell, Pose2())


def _gaps_in(ink: np.ndarray, cell: float) -> Callable[[Point, Point, float], str]:
    """Return the judge of gaps: one with strokes along it is a window, one without is a door."""
    near = binary_dilation(ink)

    def kind(start: Point, end: Point, thickness: float) -> str:
        length = math.dist(start, end)
        count = max(4, int(length / cell))
        along = np.outer(np.linspace(0.1, 0.9, count), np.subtract(end, start)) + start
        normal = np.array([start[1] - end[1], end[0] - start[0]]) / length
        offsets = np.linspace(-0.5, 0.5, 5) * thickness
        points_xy = along[:, None, :] + offsets[None, :, None] * normal
        cells = np.floor(points_xy[..., ::-1] / cell).astype(int)
        cells = np.clip(cells, 0, np.array(ink.shape) - 1)
        has_stroke = near[cells[..., 0], cells[..., 1]].any(axis=1)
        return WINDOW if has_stroke.mean() >= WINDOW_SHARE else DOOR

    return kind
