"""Images of maps."""

import base64
import io
from typing import Tuple

import numpy as np
from PIL import Image

from planar import OCCUPIED, UNKNOWN, OccupancyGrid

MARGIN = 0.3


def view_of(grid: OccupancyGrid, points_xy: np.ndarray) -> Tuple[float, float, float, float]:
    """Return x_min, y_min, x_max, y_max of the known cells of a map and of points (N, 2), with a margin."""
    corners = [points_xy] if len(points_xy) else []
    known = np.argwhere(grid.cells != UNKNOWN)
    if len(known):
        (row_min, col_min), (row_max, col_max) = known.min(axis=0), known.max(axis=0)
        cells = [(row, col) for row in (row_min, row_max) for col in (col_min, col_max)]
        corners.append(grid.points_of(np.array(cells)))
    corners_xy = np.concatenate(corners) if corners else np.array([[-1.0, -1.0], [1.0, 1.0]])
    (x_min, y_min), (x_max, y_max) = corners_xy.min(axis=0) - MARGIN, corners_xy.max(axis=0) + MARGIN
    return float(x_min), float(y_min), float(x_max), float(y_max)


def grid_image(grid: OccupancyGrid, occupied, free, unknown) -> Image.Image:
    """Return the cells as RGBA pixels in the given colours, highest row first."""
    shares = np.clip(grid.cells, 0, OCCUPIED)[..., None] / OCCUPIED
    pixels = np.array(free) * (1.0 - shares) + np.array(occupied) * shares
    pixels[grid.cells == UNKNOWN] = unknown
    return Image.fromarray(np.flipud(np.rint(pixels)).astype(np.uint8))


def data_uri(image: Image.Image) -> str:
    stream = io.BytesIO()
    image.quantize(64, Image.Quantize.FASTOCTREE).save(stream, "PNG", optimize=True)
    return "data:image/png;base64," + base64.b64encode(stream.getvalue()).decode("ascii")
