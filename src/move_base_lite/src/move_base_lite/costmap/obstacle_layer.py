"""What the laser sees: marks where beams end, clears where they passed (costmap_2d's obstacle layer)."""

import math
from dataclasses import dataclass

import numba
import numpy as np

from move_base_lite.costmap.costs import FREE, LETHAL, UNKNOWN
from move_base_lite.costmap.footprint import Footprint
from move_base_lite.costmap.window import Bounds, Window
from planar import Pose2, Scan
from planar.settings import check


@dataclass(frozen=True)
class ObstacleSettings:
    """Ranges in metres. ``expected_update_rate``: seconds after which scans are stale, 0 never."""

    enabled: bool = True
    footprint_clearing_enabled: bool = True
    topic: str = "scan"
    marking: bool = True
    clearing: bool = False
    inf_is_valid: bool = False
    obstacle_range: float = 2.5
    raytrace_range: float = 3.0
    expected_update_rate: float = 0.0

    def __post_init__(self):
        check(self.obstacle_range > 0.0, "obstacle_range", "positive", self.obstacle_range)
        check(
            self.raytrace_range >= self.obstacle_range or not self.clearing,
            "raytrace_range",
            f"at least obstacle_range ({self.obstacle_range:g}), else marks are never cleared",
            self.raytrace_range,
        )
        check(
            self.expected_update_rate >= 0.0, "expected_update_rate", "at least 0", self.expected_update_rate
        )


class ObstacleLayer:
    """Cells that scans have shown to be occupied or free, aligned with the costmap's window."""

    def __init__(self, settings: ObstacleSettings, rows: int, cols: int, track_unknown_space: bool):
        self.settings = settings
        self._default = UNKNOWN if track_unknown_space else FREE
        self.costs = np.full((rows, cols), self._default, dtype=np.uint8)

    def roll(self, rows: int, cols: int) -> None:
        """The window has moved by so many cells: keeps what is still in it."""
        moved = np.full_like(self.costs, self._default)
        height, width = self.costs.shape
        if abs(rows) < height and abs(cols) < width:
            kept = self.costs[max(rows, 0) : height + min(rows, 0), max(cols, 0) : width + min(cols, 0)]
            moved[max(-rows, 0) : height + min(-rows, 0), max(-cols, 0) : width + min(-cols, 0)] = kept
        self.costs = moved

    def integrate(self, window: Window, base_in_frame: Pose2, scan: Scan) -> Bounds:
        """Takes in one scan; returns the block of cells that may have changed."""
        laser = base_in_frame @ scan.laser_in_base
        settings = self.settings
        _integrate(
            self.costs,
            (laser.x - window.origin_x) / window.resolution,
            (laser.y - window.origin_y) / window.resolution,
            laser.yaw + scan.angles,
            scan.ranges,
            scan.range_min,
            scan.range_max,
            window.resolution,
            settings.obstacle_range if settings.marking else 0.0,
            settings.raytrace_range if settings.clearing else 0.0,
            settings.inf_is_valid,
        )
        reach = max(settings.obstacle_range, settings.raytrace_range) + window.resolution
        return window.bounds_around(laser.x, laser.y, reach)

    def clear_footprint(self, window: Window, base_in_frame: Pose2, footprint: Footprint) -> Bounds:
        """Where the robot stands there is no obstacle."""
        bounds = window.bounds_around(base_in_frame.x, base_in_frame.y, footprint.circumscribed_radius)
        corners_xy = base_in_frame.transform_points(footprint.corners_xy)
        corners = (corners_xy - (window.origin_x, window.origin_y)) / window.resolution
        _fill(self.costs, corners, bounds)
        return bounds

    def clear_outside(self, bounds: Bounds) -> None:
        """Forgets everything but the cells of ``bounds``."""
        rows, cols = slice(bounds.row_min, bounds.row_max), slice(bounds.col_min, bounds.col_max)
        kept = self.costs[rows, cols].copy()
        self.reset()
        self.costs[rows, cols] = kept

    def clear_inside(self, bounds: Bounds) -> None:
        """Forgets the cells of ``bounds``."""
        self.costs[bounds.row_min : bounds.row_max, bounds.col_min : bounds.col_max] = self._default

    def reset(self) -> None:
        self.costs.fill(self._default)


@numba.njit(cache=True)
def _integrate(
    costs, x, y, angles, ranges, range_min, range_max, resolution, mark_range, clear_range, inf_is_valid
):
    """Clears along all beams, then marks their ends. ``x``, ``y``: the laser, in cells."""
    rows, cols = costs.shape
    for i in range(ranges.size):
        reach = ranges[i]
        if math.isinf(reach) and reach > 0.0 and inf_is_valid:
            reach = range_max
        elif not (range_min <= reach < range_max):
            continue
        length = min(reach, clear_range) / resolution
        _clear_ray(costs, x, y, x + length * math.cos(angles[i]), y + length * math.sin(angles[i]))
    for i in range(ranges.size):
        reach = ranges[i]
        if range_min <= reach < range_max and reach <= mark_range:
            row = math.floor(y + reach / resolution * math.sin(angles[i]))
            col = math.floor(x + reach / resolution * math.cos(angles[i]))
            if 0 <= row < rows and 0 <= col < cols:
                costs[row, col] = LETHAL


@numba.njit(cache=True)
def _clear_ray(costs, x0, y0, x1, y1):
    """Frees the cells from (x0, y0) to just before that of (x1, y1), one per row or column."""
    rows, cols = costs.shape
    steps = int(max(abs(x1 - x0), abs(y1 - y0)))
    for step in range(steps):
        col = math.floor(x0 + (x1 - x0) * step / steps)
        row = math.floor(y0 + (y1 - y0) * step / steps)
        if 0 <= row < rows and 0 <= col < cols:
            costs[row, col] = FREE


@numba.njit(cache=True)
def _fill(costs, corners, bounds):
    """Frees the cells whose centre lies in the polygon (even-odd rule); ``corners``: (N, 2) in cells."""
    row_min, row_max, col_min, col_max = bounds
    count = corners.shape[0]
    for row in range(row_min, row_max):
        y = row + 0.5
        for col in range(col_min, col_max):
            x = col + 0.5
            inside = False
            for i in range(count):
                x0, y0 = corners[i - 1]
                x1, y1 = corners[i]
                if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0):
                    inside = not inside
            if inside:
                costs[row, col] = FREE
