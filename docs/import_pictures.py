"""The picture of imports: a map, a picture and a drawing above, the maps of the homes made of them below."""

import tempfile
from pathlib import Path

import numpy as np
from made_drawings import FLAT, INCHES, draw_floor_plan, dxf_of
from PIL import Image, ImageDraw, ImageFont

from home_builder import build_home
from home_builder.imports import import_plan
from home_builder.imports.dxf import drawn_segments
from planar import FREE, OCCUPIED, OccupancyGrid, load_map
from planar.maps.home_folder import MAP

TILE, MARGIN, LABEL_HEIGHT = (380, 300), 12, 22
# Metres around what is drawn, and pixels a metre of a drawing.
AROUND, DRAWING_SCALE = 0.3, 60
GREY = 205


def save_imports(path: Path, home_map: Path) -> None:
    """Write the picture.

    Args:
        path: PNG file.
        home_map: YAML file of the map that is imported.
    """
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        draw_floor_plan(folder / "plan.png")
        dxf_of(FLAT, folder / "flat.dxf", *INCHES)
        columns = [
            (home_map.name, _picture_of_map(load_map(home_map)), import_plan(home_map)),
            ("plan.png --scale 0.01", _trimmed(folder / "plan.png"), import_plan(folder / "plan.png", 0.01)),
            ("flat.dxf, in inches", _drawn(folder / "flat.dxf"), import_plan(folder / "flat.dxf")),
        ]
        sheet = Image.new("RGB", _size(len(columns)), "white")
        for number, (label, source, plan) in enumerate(columns):
            made = folder / f"home_{number}"
            build_home(plan, made)
            result = _picture_of_map(load_map(made / MAP))
            _paste(sheet, number, label, source, result)
        sheet.save(path)


def _size(columns: int) -> tuple:
    width = columns * (TILE[0] + MARGIN) + MARGIN
    return width, 2 * (TILE[1] + MARGIN) + LABEL_HEIGHT + MARGIN


def _paste(sheet: Image.Image, column: int, label: str, *pictures: Image.Image) -> None:
    x = MARGIN + column * (TILE[0] + MARGIN)
    ImageDraw.Draw(sheet).text((x, MARGIN // 2), label, fill="black", font=ImageFont.load_default(15))
    for row, picture in enumerate(pictures):
        fitted = picture.copy()
        fitted.thumbnail(TILE)
        y = MARGIN + LABEL_HEIGHT + row * (TILE[1] + MARGIN)
        sheet.paste(fitted, (x + (TILE[0] - fitted.width) // 2, y + (TILE[1] - fitted.height) // 2))


def _picture_of_map(grid: OccupancyGrid) -> Image.Image:
    """Return the known part of a map as map_server shows it."""
    shades = np.full(grid.cells.shape, GREY, dtype=np.uint8)
    shades[grid.cells == FREE], shades[grid.cells == OCCUPIED] = 254, 0
    rows, cols = np.nonzero(grid.cells == OCCUPIED)
    around = round(AROUND / grid.resolution)
    top, left = max(rows.min() - around, 0), max(cols.min() - around, 0)
    part = shades[top : rows.max() + around + 1, left : cols.max() + around + 1]
    picture = Image.fromarray(np.flipud(part))
    factor = min(TILE[0] / picture.width, TILE[1] / picture.height)
    return picture.resize(
        (round(picture.width * factor), round(picture.height * factor)), Image.Resampling.NEAREST
    )


def _trimmed(path: Path) -> Image.Image:
    picture = Image.open(path).convert("L")
    rows, cols = np.nonzero(np.asarray(picture) < 128)
    around = round(AROUND / 0.01)
    return picture.crop((cols.min() - around, rows.min() - around, cols.max() + around, rows.max() + around))


def _drawn(path: Path) -> Image.Image:
    """Return the lines of a drawing's walls."""
    segments = np.array(drawn_segments(path))
    low, high = segments.min(axis=(0, 1)) - AROUND, segments.max(axis=(0, 1)) + AROUND
    width, height = np.ceil((high - low) * DRAWING_SCALE).astype(int).tolist()
    picture = Image.new("L", (width, height), 255)
    draw = ImageDraw.Draw(picture)
    for ends in (segments - low) * DRAWING_SCALE:
        draw.line([(x, height - y) for x, y in ends.tolist()], fill=0, width=2)
    return picture
