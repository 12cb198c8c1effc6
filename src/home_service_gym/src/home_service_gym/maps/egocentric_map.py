"""Egocentric map: the map around the robot as an image."""

import math
from typing import Any, Optional

import numba
import numpy as np
from gymnasium import spaces

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2

# Cells along a side, and side of a cell [m].
SIDE, CELL = 64, 0.15
UNKNOWN, FREE_SHADE, OCCUPIED_SHADE = 0, 128, 255


def map_space() -> spaces.Space[Any]:
    """Return the observation space of an ``EgocentricMap``."""
    return spaces.Box(0, 255, (SIDE, SIDE), np.uint8)


class EgocentricMap:
    """A map as an image centred on the robot, which faces to the right."""

    def __init__(self, grid: OccupancyGrid):
        self._map_in_grid, self._resolution = grid.origin.inverse(), grid.resolution
        self._shades = np.full(grid.cells.shape, UNKNOWN, dtype=np.uint8)
        self._shades[grid.cells == FREE] = FREE_SHADE
        self._shades[grid.cells == OCCUPIED] = OCCUPIED_SHADE
        self._all = np.ones(grid.cells.shape, dtype=np.bool_)

    def view_from(self, base: Pose2, explored: Optional[np.ndarray] = None) -> np.ndarray:
        """Return the image (SIDE, SIDE), uint8; ``explored``: cells to show, bool (rows, cols); None: all."""
        base_in_grid = self._map_in_grid @ base
        return _draw(
            self._shades,
            self._all if explored is None else explored,
            base_in_grid.x / self._resolution,
            base_in_grid.y / self._resolution,
            base_in_grid.yaw,
            CELL / self._resolution,
        )


@numba.njit(cache=True)
def _draw(shades, explored, x, y, yaw, step):
    """``x``, ``y`` of the robot and the ``step`` between image cells, all in cells of the grid."""
    rows, cols = shades.shape
    picture = np.full((SIDE, SIDE), UNKNOWN, dtype=np.uint8)
    ahead_x, ahead_y = math.cos(yaw) * step, math.sin(yaw) * step
    middle = (SIDE - 1) / 2.0
    for down in range(SIDE):
        left = middle - down
        for right in range(SIDE):
            ahead = right - middle
            row = math.floor(y + ahead * ahead_y + left * ahead_x)
            col = math.floor(x + ahead * ahead_x - left * ahead_y)
            if 0 <= row < rows and 0 <= col < cols:
                picture[down, right] = shades[row, col] * explored[row, col]
    return picture
