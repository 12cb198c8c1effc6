"""Obstacle layer: marks the ends of beams and clears along them (costmap_2d: ObstacleLayer)."""

import math
from dataclasses import dataclass
from typing import List, Tuple

import numba
import numpy as np

from move_base_lite.costmap.combination import combine
from move_base_lite.costmap.costs import FREE, LETHAL, UNKNOWN
from move_base_lite.costmap.layer import CostmapPlacement, Layer, LayerContext, LayerSettings
from move_base_lite.costmap.observation import Observation
from move_base_lite.costmap.polygon import Polygon
from move_base_lite.costmap.window import NO_CELLS, CellBounds, CostmapWindow, union
from planar import Pose2
from planar.config.parameters import POSITIVE, at_least, check_parameters, parameter
from planar.config.settings import check
from planar.config.without_effect import IneffectiveParameter
from planar.extensions import Plugin

DATA_TYPES = ("LaserScan", "PointCloud", "PointCloud2")
OVERWRITE, MAXIMUM, IGNORE_LAYER = 0, 1, 99


@dataclass(frozen=True)
class SourceSettings:
    """Parameters of one observation source."""

    topic: str = parameter("", "topic of the sensor; default: the name of the source")
    sensor_frame: str = parameter("", "frame of the sensor; empty: the frame of its messages")
    data_type: str = parameter("PointCloud", "type of its messages", choices=DATA_TYPES)
    observation_persistence: float = parameter(
        0.0, "time for which an observation keeps marking", "s", at_least(0.0)
    )
    expected_update_rate: float = parameter(
        0.0, "time without data after which the robot stops; 0: never", "s", at_least(0.0)
    )
    min_obstacle_height: float = parameter(0.0, "lowest height above the floor that is marked", "m")
    max_obstacle_height: float = parameter(2.0, "highest height above the floor that is marked", "m")
    inf_is_valid: bool = parameter(False, "whether beams without return (inf) clear")
    marking: bool = parameter(True, "whether its returns are marked as obstacles")
    clearing: bool = parameter(False, "whether cells up to its returns are cleared")
    obstacle_range: float = parameter(2.5, "range up to which returns are marked", "m", POSITIVE)
    raytrace_range: float = parameter(3.0, "range up to which cells are cleared", "m")

    def __post_init__(self):
        check_parameters(self)
        check(
            self.raytrace_range >= self.obstacle_range or not (self.clearing and self.marking),
            "raytrace_range",
            f"at least obstacle_range ({self.obstacle_range:g}), else marks are never cleared",
            self.raytrace_range,
        )


@dataclass(frozen=True)
class ObstacleSettings(LayerSettings):
    """Parameters of the obstacle layer and its observation sources.

    Attributes:
        sources: Observation sources.
    """

    track_unknown_space: bool = parameter(
        False,
        "whether cells without observations are unknown rather than free; default: that of the costmap",
    )
    footprint_clearing_enabled: bool = parameter(
        True, "whether the footprint of the robot is cleared", dynamic=True
    )
    max_obstacle_height: float = parameter(
        2.0, "highest height above the floor that any source marks", "m", dynamic=(0.0, 50.0)
    )
    combination_method: int = parameter(
        MAXIMUM,
        "with the layers below: 0 overwrites, 1 keeps the higher cost, 99 ignores this layer",
        dynamic=True,
    )
    sources: Tuple[SourceSettings, ...] = ()

    def __post_init__(self):
        check_parameters(self)
        method = self.combination_method
        check(method in (OVERWRITE, MAXIMUM, IGNORE_LAYER), "combination_method", "0, 1 or 99", method)


@dataclass(frozen=True, eq=False)
class _LocatedObservation:
    """An observation with the pose of its sensor in the costmap's frame."""

    observation: Observation
    sensor_in_frame: Pose2

    def sensor_in_cells(self, window: CostmapWindow) -> Tuple[float, float, float, float]:
        """Return column and row of the sensor in a window, its height [m] and heading [rad]."""
        sensor, resolution = self.sensor_in_frame, window.resolution
        x, y = (sensor.x - window.origin_x) / resolution, (sensor.y - window.origin_y) / resolution
        return x, y, self.observation.sensor_height, sensor.yaw


class _ObservationBuffer:
    """Observations of one source that count at an update (costmap_2d: ObservationBuffer).

    Attributes:
        source: Parameters of the source.
        kept: The newest observation and, for ``observation_persistence``, older ones.
    """

    def __init__(self, source: SourceSettings):
        self.source = source
        self.kept: List[_LocatedObservation] = []
        self._new: List[_LocatedObservation] = []

    def add(self, located: _LocatedObservation) -> None:
        """Store an observation until the next update; it replaces older ones unless they persist."""
        self._new = [*self._new, located] if self.source.observation_persistence > 0.0 else [located]

    def take_new(self) -> bool:
        """Keep the observations since the last update and drop those that are too old.

        Returns:
            Whether there was a new one.
        """
        new, self._new = self._new, []
        if not new:
            return False
        oldest = new[-1].observation.stamp - self.source.observation_persistence
        persistent = [*self.kept, *new[:-1]] if self.source.observation_persistence > 0.0 else []
        self.kept = [each for each in persistent if each.observation.stamp >= oldest] + new[-1:]
        return True


class ObstacleLayer(Layer):
    """Occupied and free cells observed by sensors, aligned with the costmap's window."""

    def __init__(self, settings: ObstacleSettings, context: LayerContext):
        self._settings, self._footprint = settings, context.footprint
        self._default = UNKNOWN if settings.track_unknown_space else FREE
        self._buffers = [_ObservationBuffer(source) for source in settings.sources]
        self._window = context.window
        self._costs = np.full((context.window.rows, context.window.cols), self._default, dtype=np.uint8)

    def add_observation(self, observation: Observation, base_in_frame: Pose2) -> None:
        """Store an observation until the next update; it replaces an older one of the same sensor.

        Args:
            observation: Beams of one sensor.
            base_in_frame: Robot pose in the costmap's frame when they were measured.
        """
        for buffer in self._buffers:
            if buffer.source.topic == observation.topic:
                sensor_in_frame = base_in_frame @ observation.sensor_in_base
                buffer.add(_LocatedObservation(observation, sensor_in_frame))

    def update(self, placement: CostmapPlacement) -> CellBounds:
        """Clear along the beams of all sensors, mark their ends, clear the footprint (see Layer.update)."""
        window, changed = placement.window, NO_CELLS
        has_rolled, received = self._roll(window), [buffer.take_new() for buffer in self._buffers]
        if has_rolled or True in received:
            changed = self._integrate_kept(window)
        if self._settings.footprint_clearing_enabled:
            outline_xy = placement.base_in_frame.transform_points(self._footprint.corners_xy)
            changed = union(changed, Polygon(outline_xy).fill(self._costs, window, FREE))
        return changed

    def _integrate_kept(self, window: CostmapWindow) -> CellBounds:
        """Clear along the beams of all observations, then mark their ends.

        All of them, not only new ones: what a source has marked last stays until its next observation, even
        if another one clears there.
        """
        changed = NO_CELLS
        for buffer in self._buffers:
            source = buffer.source
            reach = max(source.obstacle_range, source.raytrace_range) + window.resolution
            for located in buffer.kept:
                if source.clearing:
                    self._integrate(window, source, located, 0.0, source.raytrace_range)
                sensor = located.sensor_in_frame
                changed = union(changed, window.bounds_around(sensor.x, sensor.y, reach))
        for buffer in self._buffers:
            for located in buffer.kept:
                if buffer.source.marking:
                    self._integrate(window, buffer.source, located, buffer.source.obstacle_range, 0.0)
        return changed

    def _integrate(self, window, source, located, mark_range: float, clear_range: float) -> None:
        observation, sensor = located.observation, located.sensor_in_frame
        # numba finds the type of a plain tuple several times as fast as that of a named one.
        block = tuple(window.bounds_around(sensor.x, sensor.y, max(mark_range, clear_range)))
        _integrate(
            self._costs,
            block,
            located.sensor_in_cells(window),
            observation.directions_xy,
            observation.ranges,
            np.atleast_1d(observation.heights),
            (source.min_obstacle_height, source.max_obstacle_height, self._settings.max_obstacle_height),
            (observation.range_min, observation.range_max),
            window.resolution,
            mark_range,
            math.ceil(clear_range / window.resolution),
            source.inf_is_valid,
        )

    def _roll(self, window: CostmapWindow) -> bool:
        """Move the cells with the window; those that enter it get the default cost.

        Returns:
            Whether the window has moved since the last update of this layer.
        """
        before, self._window = self._window, window
        cols = round((window.origin_x - before.origin_x) / window.resolution)
        rows = round((window.origin_y - before.origin_y) / window.resolution)
        if not (rows or cols):
            return False
        self._shift(rows, cols)
        return True

    def _shift(self, rows: int, cols: int) -> None:
        self._costs = rolled(self._costs, rows, cols, self._default)

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds: CellBounds) -> None:
        if self._settings.combination_method != IGNORE_LAYER:
            combine(costs, self._costs, tuple(bounds), self._settings.combination_method == OVERWRITE)

    def clear_outside(self, bounds: CellBounds, window: CostmapWindow) -> CellBounds:
        rows, cols = bounds.slices
        kept = self._costs[rows, cols].copy()
        self._costs.fill(self._default)
        for buffer in self._buffers:
            buffer.kept.clear()
        self._costs[rows, cols] = kept
        return window.everything

    def clear_inside(self, bounds: CellBounds) -> CellBounds:
        self._costs[bounds.slices] = self._default
        return bounds

    def take_over(self, before: Layer) -> None:
        assert isinstance(before, ObstacleLayer)
        self._costs, self._window = before._costs, before._window
        for buffer in self._buffers:
            same = [each for each in before._buffers if each.source == buffer.source]
            buffer.kept = same[0].kept if same else []


def rolled(cells: np.ndarray, rows: int, cols: int, default: int) -> np.ndarray:
    """Return the cells of a window that has moved.

    Args:
        cells: Cells before (rows, cols).
        rows: Rows by which the window has moved.
        cols: Columns by which the window has moved.
        default: Value of the cells that have entered the window.
    """
    moved = np.full_like(cells, default)
    height, width = cells.shape
    if abs(rows) < height and abs(cols) < width:
        kept = cells[max(rows, 0) : height + min(rows, 0), max(cols, 0) : width + min(cols, 0)]
        moved[max(-rows, 0) : height + min(-rows, 0), max(-cols, 0) : width + min(-cols, 0)] = kept
    return moved


@numba.njit(cache=True)
def _integrate(
    costs, block, sensor, directions, ranges, heights, height_limits, range_limits, resolution, mark_range,
    clear_cells, inf_is_valid,
):  # fmt: skip
    """Clear along all beams, at most so many cells, or mark their ends.

    ``sensor`` is its position, x and y in cells, z in metres, and its yaw; ``block`` contains all cells that
    can change; ``height_limits`` are those of the source and the highest that is marked. Marks count by their
    distance from the sensor in three dimensions. Of rays with the same end in the block one is traced.
    """
    x, y, z, yaw = sensor
    c, s = math.cos(yaw) / resolution, math.sin(yaw) / resolution
    row_min, row_max, col_min, col_max = block
    traced = np.zeros((2, row_max - row_min, col_max - col_min), dtype=np.bool_)
    for i in range(ranges.size):
        height = heights[i] if heights.size > 1 else heights[0]
        if not height_limits[0] <= height <= height_limits[1]:
            continue
        reach, is_return = ranges[i], True
        if math.isinf(reach) and reach > 0.0 and inf_is_valid:
            reach, is_return = range_limits[1], False
        elif not (range_limits[0] <= reach < range_limits[1]):
            continue
        end_x = x + reach * (c * directions[i, 0] - s * directions[i, 1])
        end_y = y + reach * (s * directions[i, 0] + c * directions[i, 1])
        if clear_cells > 0:
            row, col, is_cut = _cut_to_costs(costs, x, y, end_x, end_y)
            spares_end = is_return and not is_cut
            if row_min <= row < row_max and col_min <= col < col_max:
                if traced[int(spares_end), row - row_min, col - col_min]:
                    continue
                traced[int(spares_end), row - row_min, col - col_min] = True
            _clear_ray(costs, math.floor(x), math.floor(y), col, row, clear_cells, spares_end)
        elif (
            is_return
            and height <= height_limits[2]
            and reach * reach + (height - z) * (height - z) < mark_range * mark_range
        ):
            row, col = math.floor(end_y), math.floor(end_x)
            if row_min <= row < row_max and col_min <= col < col_max:
                costs[row, col] = LETHAL


@numba.njit(cache=True)
def _cut_to_costs(costs, x, y, end_x, end_y):
    """Row and column of the end of a ray, or of the last cell before it leaves the costs; whether it does."""
    rows, cols = costs.shape
    part = 1.0
    if end_x < 0.0:
        part = min(part, x / (x - end_x))
    elif end_x >= cols:
        part = min(part, (cols - x) / (end_x - x))
    if end_y < 0.0:
        part = min(part, y / (y - end_y))
    elif end_y >= rows:
        part = min(part, (rows - y) / (end_y - y))
    row, col = math.floor(y + part * (end_y - y)), math.floor(x + part * (end_x - x))
    return min(max(row, 0), rows - 1), min(max(col, 0), cols - 1), part < 1.0


@numba.njit(cache=True)
def _clear_ray(costs, col, row, end_col, end_row, most_cells, spares_end):
    """Clear the cells of a line, at most so many (costmap_2d: raytraceLine, by Bresenham's algorithm).

    ``spares_end``: whether the cell at its end stays, as it contains a return.
    """
    rows, cols = costs.shape
    across, up = abs(end_col - col), abs(end_row - row)
    col_step, row_step = 1 if end_col > col else -1, 1 if end_row > row else -1
    length = math.sqrt(across * across + up * up)
    long, short = max(across, up), min(across, up)
    steps, error = long, long // 2
    if length > most_cells:
        steps, spares_end = int(most_cells / length * long), False
    for step in range(steps + 1):
        if not (0 <= row < rows and 0 <= col < cols) or (spares_end and step == steps):
            return
        costs[row, col] = FREE
        error += short
        turns = error >= long
        error -= long * turns
        col += col_step * (across >= up or turns)
        row += row_step * (across < up or turns)


# Parameters that are read with the sources.
ELSEWHERE = frozenset({"observation_sources", "obstacle_range", "raytrace_range"})
TOLERANCE = IneffectiveParameter("transform_tolerance", 0.2, "that of the costmap applies", is_dynamic=False)
OBSTACLES: Plugin[Layer] = Plugin(
    "costmap_2d::ObstacleLayer",
    ObstacleSettings,
    ObstacleLayer,
    without_effect=(TOLERANCE,),
    elsewhere=ELSEWHERE,
)
