"""Frontiers between free and unknown space.

Yamauchi, "A frontier-based approach for autonomous exploration", 1997.
"""

from dataclasses import dataclass
from typing import List

import numpy as np
from scipy.ndimage import binary_dilation, find_objects, label

from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid

# Occupancy [%] up to which a cell is free and from which on it is occupied.
FREE_AT = 25
OCCUPIED_AT = 65
EIGHT_NEIGHBOURS = np.ones((3, 3), dtype=bool)


@dataclass(frozen=True, eq=False)
class Frontier:
    """Neighbouring free cells at the border of unknown space.

    Attributes:
        points_xy: Cell centres (N, 2) in the map frame [m].
        size: Number of cells times the resolution [m].
    """

    points_xy: np.ndarray
    size: float

    @property
    def middle_xy(self) -> np.ndarray:
        """The point (2,) nearest to the mean of all points."""
        offsets = self.points_xy - self.points_xy.mean(axis=0)
        return self.points_xy[np.argmin((offsets**2).sum(axis=1))]

    def distance_to(self, point_xy: np.ndarray) -> float:
        """Return the distance from a point to the nearest point of the frontier [m].

        Args:
            point_xy: The point (2,) in the map frame [m].
        """
        return float(np.sqrt(((self.points_xy - point_xy) ** 2).sum(axis=1).min()))


def known_part(grid: OccupancyGrid) -> OccupancyGrid:
    """Crop a map to its known cells plus one unknown cell on each side, and threshold the occupancy.

    A SLAM map may be much larger than its known part: gmapping starts with 200 x 200 m.

    Args:
        grid: Map with occupancies from 0 to 100 %.

    Returns:
        A map of free, occupied and unknown cells.
    """
    rows, cols = (np.flatnonzero((grid.cells != UNKNOWN).any(axis=axis)) for axis in (1, 0))
    if len(rows) == 0:
        return OccupancyGrid(np.full((1, 1), UNKNOWN, dtype=np.int8), grid.resolution, grid.origin)
    known = np.pad(grid.cells[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1], 1, constant_values=UNKNOWN)
    cells = np.full(known.shape, UNKNOWN, dtype=np.int8)
    cells[(known >= 0) & (known <= FREE_AT)] = FREE
    cells[known >= OCCUPIED_AT] = OCCUPIED
    half = grid.resolution / 2.0
    x, y = grid.points_of(np.array([[rows[0] - 1, cols[0] - 1]]))[0]
    corner = type(grid.origin)(x, y, grid.origin.yaw) @ type(grid.origin)(-half, -half)
    return OccupancyGrid(cells, grid.resolution, corner)


def find_frontiers(grid: OccupancyGrid, min_size: float, max_size: float) -> List[Frontier]:
    """Find the frontiers of a map (Yamauchi, 1997).

    Args:
        grid: Free, occupied and unknown cells (see known_part); space outside of it is unknown.
        min_size: Minimum length [m].
        max_size: Length above which a frontier is split [m].
    """
    beside_unknown = binary_dilation(grid.cells == UNKNOWN, EIGHT_NEIGHBOURS, border_value=1)
    labels, _ = label((grid.cells == FREE) & beside_unknown, EIGHT_NEIGHBOURS)
    frontiers = []
    for number, box in enumerate(find_objects(labels), 1):
        cells = np.argwhere(labels[box] == number) + [box[0].start, box[1].start]
        if len(cells) * grid.resolution < min_size:
            continue
        for part in _split(cells, max_size / grid.resolution):
            frontiers.append(Frontier(grid.points_of(part), len(part) * grid.resolution))
    return frontiers


def _split(cells: np.ndarray, max_extent: float) -> List[np.ndarray]:
    """Halve cells (N, 2) across their longer side until no part is longer than ``max_extent``."""
    extents = np.ptp(cells, axis=0)
    axis = int(np.argmax(extents))
    if extents[axis] < max_extent:
        return [cells]
    low = cells[:, axis] < np.median(cells[:, axis])
    if not low.any():
        return [cells]
    return _split(cells[low], max_extent) + _split(cells[~low], max_extent)
