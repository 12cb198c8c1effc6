"""What the map is like around the robot, as a picture."""

from typing import Any, Optional

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
    ticks = (np.arange(SIDE) - (SIDE - 1) / 2.0) * CELL
    x, y = np.meshgrid(ticks, ticks[::-1])
    points_xy = base.transform_points(np.column_stack((x.ravel(), y.ravel())))
    cells = grid.cells_of(points_xy)
    inside = grid.contains(cells)
    rows, cols = cells[inside].T
    found = grid.cells[rows, cols]
    values = np.select((found == OCCUPIED, found == FREE), (SOLID, OPEN), NOTHING)
    picture = np.full(SIDE * SIDE, NOTHING, dtype=np.uint8)
    picture[inside] = values if known is None else np.where(known[rows, cols], values, NOTHING)
    return picture.reshape(SIDE, SIDE)
