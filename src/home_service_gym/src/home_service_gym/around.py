"""What the map is like around the robot, as a picture."""

import math
from typing import Any, Optional

import numba
import numpy as np
from gymnasium import spaces

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2

# Cells along a side, and metres of a cell.
SIDE, CELL = 64, 0.15
NOTHING, OPEN, SOLID = 0, 128, 255


def map_space() -> spaces.Space[Any]:
    """Of what ``map_around`` gives."""
    return spaces.Box(0, 255, (SIDE, SIDE), np.uint8)


def map_around(grid: OccupancyGrid, base: Pose2, known: Optional[np.ndarray] = None) -> np.ndarray:
    """The grid seen from above with the robot in the middle, looking to the right: (SIDE, SIDE), uint8.

    ``known``: which of its cells, bool (rows, cols), are shown; None: all.
    """
    place = grid.origin.inverse() @ base
    shown = np.empty((0, 0), dtype=np.bool_) if known is None else known
    return _draw(
        grid.cells,
        shown,
        place.x / grid.resolution,
        place.y / grid.resolution,
        place.yaw,
        CELL / grid.resolution,
    )


@numba.njit(cache=True)
def _draw(cells, known, x, y, yaw, step):
    """``x``, ``y``: of the robot, and ``step``, between the picture's cells, all in cells of the grid."""
    rows, cols = cells.shape
    picture = np.full((SIDE, SIDE), NOTHING, dtype=np.uint8)
    ahead_x, ahead_y = math.cos(yaw) * step, math.sin(yaw) * step
    middle = (SIDE - 1) / 2.0
    for down in range(SIDE):
        left = middle - down
        for right in range(SIDE):
            ahead = right - middle
            row = math.floor(y + ahead * ahead_y + left * ahead_x)
            col = math.floor(x + ahead * ahead_x - left * ahead_y)
            if 0 <= row < rows and 0 <= col < cols and (known.size == 0 or known[row, col]):
                if cells[row, col] == OCCUPIED:
                    picture[down, right] = SOLID
                elif cells[row, col] == FREE:
                    picture[down, right] = OPEN
    return picture
