"""FurniturePiece from solid cells that are no walls: boxes and outlines."""

import math
from typing import Iterator, List

import numpy as np
import shapely
from scipy.ndimage import find_objects, label
from shapely import affinity
from shapely.geometry import Polygon, box

from home_builder.imports.wall_strips import SolidCells
from home_builder.palette import OUTLINE
from home_builder.plan.model import FurniturePiece

# Share of its smallest rectangle that a box fills; height of furniture on a map [m].
BOX_FILL, HEIGHT = 0.9, 0.8
DIGITS = 4


def furniture_from_cells(solid: SolidCells) -> List[FurniturePiece]:
    """Return a piece of furniture for each connected part of solid cells.

    Args:
        solid: Cells that are solid but in no wall.
    """
    labels, _ = label(solid.cells, structure=np.ones((3, 3)))
    pieces: List[FurniturePiece] = []
    for number, window in enumerate(find_objects(labels), 1):
        part = labels[window] == number
        corner = np.array([window[1].start, window[0].start]) * solid.resolution + solid.corner
        shape = cells_polygon(part, solid.resolution)
        for polygon in _simple(shape, solid.resolution):
            pieces.append(piece_of(affinity.translate(polygon, *corner)))
    return pieces


def cells_polygon(part: np.ndarray, resolution: float):
    """Return the area of cells (rows, cols) as a polygon or several, with the corner at the origin [m]."""
    boxes = []
    for row, line in enumerate(part):
        edges = np.flatnonzero(np.diff(np.concatenate(([0], line.astype(np.int8), [0]))))
        boxes += [box(first, row, last, row + 1) for first, last in zip(edges[::2], edges[1::2])]
    return affinity.scale(shapely.union_all(boxes), resolution, resolution, origin=(0.0, 0.0))


def _simple(shape, resolution: float) -> Iterator[Polygon]:
    """Yield polygons without holes that cover a shape, with corners of less than a cell left out."""
    simplified = shape.simplify(0.6 * resolution)
    for polygon in getattr(simplified, "geoms", [simplified]):
        yield from without_holes(polygon if polygon.is_valid else polygon.buffer(0.0))


def without_holes(polygon) -> Iterator[Polygon]:
    """Yield the parts of a polygon that is cut through its holes, as furniture has an outline only."""
    if not isinstance(polygon, Polygon):  # several; lines and points between them are none
        for part in getattr(polygon, "geoms", ()):
            yield from without_holes(part)
    elif not polygon.interiors:
        if polygon.area > 1e-6:
            yield polygon
    else:
        low_x, low_y, high_x, high_y = polygon.bounds
        cut = polygon.interiors[0].centroid.x
        for half in (box(low_x, low_y, cut, high_y), box(cut, low_y, high_x, high_y)):
            yield from without_holes(polygon.intersection(half))


def piece_of(polygon: Polygon, height: float = HEIGHT, name: str = "") -> FurniturePiece:
    """Return a polygon as a piece of furniture: a box if it is about a rectangle, else an outline."""
    rectangle = shapely.minimum_rotated_rectangle(polygon)
    if isinstance(rectangle, Polygon) and polygon.area >= BOX_FILL * rectangle.area:
        return _box(rectangle, height, name)
    middle = polygon.centroid
    x, y = round(middle.x, DIGITS), round(middle.y, DIGITS)
    corners = np.asarray(polygon.exterior.coords)[:-1] - (x, y)
    low_x, low_y, high_x, high_y = polygon.bounds
    size = (round(high_x - low_x, DIGITS), round(high_y - low_y, DIGITS), height)
    outline = tuple((round(a, DIGITS), round(b, DIGITS)) for a, b in corners.tolist())
    return FurniturePiece(OUTLINE, x, y, 0.0, size, name, outline)


def _box(rectangle: Polygon, height: float, name: str) -> FurniturePiece:
    corners = np.asarray(rectangle.exterior.coords)
    sides = np.diff(corners[:3], axis=0)
    width, depth = np.hypot(*sides.T).tolist()
    yaw = math.atan2(sides[0][1], sides[0][0])
    x, y = corners[:4].mean(axis=0).tolist()
    size = (round(width, DIGITS), round(depth, DIGITS), height)
    return FurniturePiece("box", round(x, DIGITS), round(y, DIGITS), round(yaw, 5), size, name)
