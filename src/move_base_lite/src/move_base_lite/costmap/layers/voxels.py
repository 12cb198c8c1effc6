"""Voxel layer: marks and clears in three dimensions, in columns of voxels (costmap_2d: VoxelLayer)."""

import math
from dataclasses import dataclass

import numba
import numpy as np

from move_base_lite.costmap.costs import FREE, LETHAL, UNKNOWN
from move_base_lite.costmap.layer import Layer, LayerContext
from move_base_lite.costmap.layers.obstacles import (
    ELSEWHERE,
    TOLERANCE,
    ObstacleLayer,
    ObstacleSettings,
    rolled,
)
from move_base_lite.costmap.window import CellBounds, CostmapWindow
from planar.config.parameters import POSITIVE, Interval, parameter
from planar.config.without_effect import IneffectiveParameter
from planar.extensions import Plugin

# Voxels of a column. A column is 32 bits: bit z is set while voxel z is unknown or marked, bit z + 16 while
# it is marked (voxel_grid: VoxelGrid).
VOXELS_PER_COLUMN = 16
UNKNOWN_COLUMN = 0xFFFF
# A ray clears up to so many cells before its end (raytraceFreespace), and not above this distance below the
# maximum height [m].
CELLS_BEFORE_END, BELOW_TOP = 2.0, 0.01


@dataclass(frozen=True)
class VoxelSettings(ObstacleSettings):
    """Parameters of the voxel layer and its observation sources."""

    origin_z: float = parameter(0.0, "height of the lowest voxels", "m", dynamic=(0.0, math.inf))
    z_resolution: float = parameter(0.2, "height of a voxel", "m", POSITIVE, dynamic=(0.0, 50.0))
    z_voxels: int = parameter(
        10, "number of voxels in a column", bounds=Interval(0, VOXELS_PER_COLUMN), dynamic=(0, 16)
    )
    unknown_threshold: int = parameter(
        15,
        "most unknown voxels of a column that is free",
        bounds=Interval(0, VOXELS_PER_COLUMN),
        dynamic=(0, 16),
    )
    mark_threshold: int = parameter(
        0,
        "most marked voxels of a column that is free",
        bounds=Interval(0, VOXELS_PER_COLUMN),
        dynamic=(0, 16),
    )


class VoxelLayer(ObstacleLayer):
    """Occupied, free and unknown voxels observed by sensors; a cell's cost follows from its column."""

    def __init__(self, settings: VoxelSettings, context: LayerContext):
        super().__init__(settings, context)
        self._voxels = settings
        self._columns = np.full(self._costs.shape, UNKNOWN_COLUMN, dtype=np.uint32)

    def _integrate(self, window, source, located, mark_range: float, clear_range: float) -> None:
        settings, observation, sensor = self._voxels, located.observation, located.sensor_in_frame
        block = tuple(window.bounds_around(sensor.x, sensor.y, max(mark_range, clear_range)))
        _integrate(
            self._costs,
            self._columns,
            block,
            located.sensor_in_cells(window),
            observation.directions_xy,
            observation.ranges,
            np.atleast_1d(observation.heights),
            (source.min_obstacle_height, source.max_obstacle_height, settings.max_obstacle_height),
            (observation.range_min, observation.range_max),
            window.resolution,
            (settings.origin_z, settings.z_resolution, settings.z_voxels),
            (settings.mark_threshold, settings.unknown_threshold + VOXELS_PER_COLUMN - settings.z_voxels),
            mark_range,
            math.ceil(clear_range / window.resolution),
            source.inf_is_valid,
        )

    def _shift(self, rows: int, cols: int) -> None:
        super()._shift(rows, cols)
        self._columns = rolled(self._columns, rows, cols, UNKNOWN_COLUMN)

    def clear_outside(self, bounds: CellBounds, window: CostmapWindow) -> CellBounds:
        kept = self._columns[bounds.slices].copy()
        self._columns.fill(UNKNOWN_COLUMN)
        self._columns[bounds.slices] = kept
        return super().clear_outside(bounds, window)

    def clear_inside(self, bounds: CellBounds) -> CellBounds:
        self._columns[bounds.slices] = UNKNOWN_COLUMN
        return super().clear_inside(bounds)

    def take_over(self, before: Layer) -> None:
        assert isinstance(before, VoxelLayer)
        if self._grid == before._grid:
            super().take_over(before)
            self._columns = before._columns

    @property
    def _grid(self):
        """Heights of the voxels; the columns of another grid cannot be taken over."""
        return self._voxels.origin_z, self._voxels.z_resolution, self._voxels.z_voxels


@numba.njit(cache=True)
def _integrate(
    costs, columns, block, sensor, directions, ranges, heights, height_limits, range_limits, resolution, grid,
    thresholds, mark_range, clear_cells, inf_is_valid,
):  # fmt: skip
    """Clear along all beams, at most so many cells, or mark their ends.

    ``sensor`` is its position, x and y in cells, z in metres, and its yaw; ``block`` contains all cells that
    can change; ``height_limits`` are those of the source and the highest that is marked or cleared; ``grid``:
    lowest height, height and number of voxels; ``thresholds``: most marked and most unknown voxels of a free
    column, with those that the column does not use. Of rays with the same last voxel one is traced.
    """
    x, y, z, yaw = sensor
    origin_z, z_resolution, z_voxels = grid
    row_min, row_max, col_min, col_max = block
    c, s = math.cos(yaw) / resolution, math.sin(yaw) / resolution
    rows, cols = costs.shape
    start_z = math.floor((z - origin_z) / z_resolution)
    if clear_cells > 0 and not (0.0 <= x < cols and 0.0 <= y < rows and 0 <= start_z < z_voxels):
        return
    traced = np.zeros((row_max - row_min, col_max - col_min), dtype=np.uint16)
    for i in range(ranges.size):
        height = heights[i] if heights.size > 1 else heights[0]
        reach, is_return = _reach_of(ranges[i], range_limits, inf_is_valid)
        if reach < 0.0 or not height_limits[0] <= height <= height_limits[1]:
            continue
        dx = reach * (c * directions[i, 0] - s * directions[i, 1])
        dy = reach * (s * directions[i, 0] + c * directions[i, 1])
        dz, distance = height - z, math.sqrt(reach * reach + (height - z) ** 2)
        if clear_cells == 0:
            is_marked = is_return and height <= height_limits[2] and distance < mark_range
            row, col = math.floor(y + dy), math.floor(x + dx)
            level = math.floor((max(height, origin_z) - origin_z) / z_resolution)
            if is_marked and row_min <= row < row_max and col_min <= col < col_max and level < z_voxels:
                _mark_voxel(costs, columns, row, col, level, thresholds)
            continue
        ray = x, y, z, dx, dy, dz, distance / resolution
        row, col, level, part = _end_of_ray(ray, rows, cols, grid, height_limits[2])
        if level < 0:
            continue
        if row_min <= row < row_max and col_min <= col < col_max:
            if traced[row - row_min, col - col_min] >> level & 1:
                continue
            traced[row - row_min, col - col_min] |= 1 << level
        length = part * math.sqrt(dx * dx + dy * dy + (dz / z_resolution) ** 2)
        share = clear_cells / length if length > clear_cells else 1.0
        _clear_ray(costs, columns, (int(x), int(y), start_z), (col, row, level), share, thresholds)


@numba.njit(cache=True)
def _reach_of(measured, range_limits, inf_is_valid):
    """Length of a beam, -1 if it is not used, and whether it has a return."""
    if math.isinf(measured) and measured > 0.0 and inf_is_valid:
        return range_limits[1], False
    return (measured, True) if range_limits[0] <= measured < range_limits[1] else (-1.0, False)


@numba.njit(cache=True)
def _end_of_ray(ray, rows, cols, grid, max_height):
    """Row, column and level of the last voxel that a ray clears, and the part of the ray up to there.

    ``ray``: origin and vector, x and y in cells, z in metres, and its length in cells. The level is -1 if the
    voxel does not exist.
    """
    x, y, z, dx, dy, dz, cells = ray
    origin_z, z_resolution, z_voxels = grid
    part = max(0.0, 1.0 - CELLS_BEFORE_END / cells) if cells > 0.0 else 0.0
    part *= _part_inside(x, y, z, part * dx, part * dy, part * dz, rows, cols, origin_z, max_height)
    row, col = math.floor(y + part * dy), math.floor(x + part * dx)
    level = math.floor((z + part * dz - origin_z) / z_resolution + 1e-9)
    is_inside = 0 <= row < rows and 0 <= col < cols and 0 <= level < z_voxels
    return row, col, level if is_inside else -1, part


@numba.njit(cache=True)
def _mark_voxel(costs, columns, row, col, level, thresholds):
    """Mark a voxel, and its cell if more voxels of the column are marked than a free one may have."""
    column = columns[row, col] | (np.uint32(0x10001) << np.uint32(level))
    columns[row, col] = column
    if _count_bits(column >> np.uint32(VOXELS_PER_COLUMN)) > thresholds[0]:
        costs[row, col] = LETHAL


@numba.njit(cache=True)
def _part_inside(x, y, z, dx, dy, dz, rows, cols, origin_z, max_height):
    """Part of a ray up to where it leaves the costs, the lowest voxels or the maximum height."""
    part = 1.0
    if z + dz > max_height:
        part = max(0.0, min(part, (max_height - BELOW_TOP - z) / dz))
    elif z + dz < origin_z:
        part = min(part, (origin_z - z) / dz)
    if x + dx < 0.0:
        part = min(part, -x / dx)
    if y + dy < 0.0:
        part = min(part, -y / dy)
    if x + dx > cols - 0.5:
        part = min(part, (cols - 0.5 - x) / dx)
    if y + dy > rows - 0.5:
        part = min(part, (rows - 0.5 - y) / dy)
    return part


@numba.njit(cache=True)
def _clear_ray(costs, columns, start, end, part, thresholds):
    """Clear the voxels of a part of a line (voxel_grid: raytraceLine, by Bresenham's algorithm)."""
    col, row, level = start
    across, along, up = abs(end[0] - col), abs(end[1] - row), abs(end[2] - level)
    col_step, row_step = 1 if end[0] > col else -1, 1 if end[1] > row else -1
    level_step = 1 if end[2] > level else -1
    long = max(across, along, up)
    col_error = row_error = level_error = long // 2
    steps = int(part * long)
    for step in range(steps + 1):
        _clear_voxel(costs, columns, row, col, level, thresholds)
        if step == steps:
            return
        col_error += across
        row_error += along
        level_error += up
        if col_error >= long:
            col, col_error = col + col_step, col_error - long
        if row_error >= long:
            row, row_error = row + row_step, row_error - long
        if level_error >= long:
            level, level_error = level + level_step, level_error - long


@numba.njit(cache=True)
def _clear_voxel(costs, columns, row, col, level, thresholds):
    """Clear a voxel and set the cost of its cell unless too many voxels of the column are marked."""
    column = columns[row, col] & ~(np.uint32(0x10001) << np.uint32(level))
    columns[row, col] = column
    marked = column >> np.uint32(VOXELS_PER_COLUMN)
    if _count_bits(marked) <= thresholds[0]:
        unknown = (marked ^ column) & np.uint32(UNKNOWN_COLUMN)
        costs[row, col] = FREE if _count_bits(unknown) <= thresholds[1] else UNKNOWN


@numba.njit(cache=True)
def _count_bits(value):
    """Number of bits that are set."""
    count = 0
    while value:
        value &= value - np.uint32(1)
        count += 1
    return count


NOT_PUBLISHED = "the topic voxel_grid is not published"
VOXEL: Plugin[Layer] = Plugin(
    "costmap_2d::VoxelLayer",
    VoxelSettings,
    VoxelLayer,
    without_effect=(
        IneffectiveParameter("publish_voxel_map", False, NOT_PUBLISHED, is_dynamic=False),
        TOLERANCE,
    ),
    elsewhere=ELSEWHERE,
)
