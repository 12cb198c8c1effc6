"""A coarse occupancy raster of axis-aligned rectangles, for fast reachability checks."""

from typing import Tuple

import numpy as np
from scipy.ndimage import label

from planar.geometry.distance_field import distance_field

RESOLUTION = 0.05


class Raster:
    """Occupancy of the rectangle from the origin to (``width``, ``depth``) [m]."""

    def __init__(self, width: float, depth: float):
        # Two cells of wall all around.
        self._solid = np.ones((int(depth / RESOLUTION) + 4, int(width / RESOLUTION) + 4), dtype=bool)
        self._solid[2:-2, 2:-2] = False

    def fill(self, x1: float, y1: float, x2: float, y2: float) -> None:
        """Mark a rectangle as solid."""
        (row1, col1), (row2, col2) = _cell(x1, y1), _cell(x2, y2)
        self._solid[row1 : row2 + 1, col1 : col2 + 1] = True

    def copy(self) -> "Raster":
        other = Raster(0.0, 0.0)
        other._solid = self._solid.copy()
        return other

    @property
    def solid(self) -> np.ndarray:
        """Solid cells, bool (rows, cols)."""
        return self._solid

    def reachable_from(self, x: float, y: float, radius: float) -> np.ndarray:
        """Return the cells a robot of this radius can reach from (x, y), bool (rows, cols)."""
        regions, _ = label(distance_field(self._solid, RESOLUTION) > radius)
        here = regions[_cell(x, y)]
        return regions == here if here else np.zeros_like(self._solid)


def _cell(x: float, y: float) -> Tuple[int, int]:
    return max(int(y / RESOLUTION) + 2, 0), max(int(x / RESOLUTION) + 2, 0)
