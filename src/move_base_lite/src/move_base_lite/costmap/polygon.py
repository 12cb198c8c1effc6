"""Polygons in the plane, and their rasterisation."""

from dataclasses import dataclass

import numba
import numpy as np

from move_base_lite.costmap.window import CellBounds, CostmapWindow
from planar import Pose2


@dataclass(frozen=True, eq=False)
class Polygon:
    """A polygon; inside and outside follow the even-odd rule.

    Attributes:
        corners_xy: (N, 2) corners, clockwise or counter-clockwise [m].
    """

    corners_xy: np.ndarray

    def contains(self, x: float, y: float) -> bool:
        """Check whether a point lies inside.

        Args:
            x: Position in the polygon's frame [m].
            y: Position in the polygon's frame [m].
        """
        return bool(_contains(self.corners_xy, x, y))

    def in_frame(self, map_in_frame: Pose2) -> "Polygon":
        """Transform the polygon from the map to another frame.

        Args:
            map_in_frame: Map in the other frame.
        """
        return Polygon(map_in_frame.transform_points(self.corners_xy))

    def fill(self, costs: np.ndarray, window: CostmapWindow, cost: int) -> CellBounds:
        """Set the cost of the cells whose centre lies inside.

        Args:
            costs: uint8 (rows, cols), changed in place.
            window: Position of the cells.
            cost: New cost.

        Returns:
            Block that encloses the polygon, cut to the window.
        """
        corners = (self.corners_xy - (window.origin_x, window.origin_y)) / window.resolution
        col_min, row_min = map(int, np.floor(corners.min(axis=0)))
        col_max, row_max = map(int, np.ceil(corners.max(axis=0)))
        bounds = window.cut(CellBounds(row_min, row_max, col_min, col_max))
        _fill(costs, corners, tuple(bounds), cost)
        return bounds


@numba.njit(cache=True)
def _fill(costs, corners, bounds, cost):
    row_min, row_max, col_min, col_max = bounds
    for row in range(row_min, row_max):
        for col in range(col_min, col_max):
            if _contains(corners, col + 0.5, row + 0.5):
                costs[row, col] = cost


@numba.njit(cache=True)
def _contains(corners, x, y):
    inside = False
    for i in range(corners.shape[0]):
        x0, y0 = corners[i - 1]
        x1, y1 = corners[i]
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0):
            inside = not inside
    return inside
