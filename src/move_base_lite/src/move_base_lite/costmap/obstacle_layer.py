"""What sensors see: marks where beams end, clears where they passed (costmap_2d's obstacle layer)."""

import math
from dataclasses import dataclass
from typing import Dict, List, Tuple

import numba
import numpy as np

from move_base_lite.costmap.costs import FREE, LETHAL, UNKNOWN
from move_base_lite.costmap.footprint import Footprint
from move_base_lite.costmap.polygon import Polygon
from move_base_lite.costmap.sighting import Sighting
from move_base_lite.costmap.window import NO_CELLS, Bounds, Window, union
from planar import Pose2
from planar.config.settings import check

DATA_TYPES = ("LaserScan", "PointCloud", "PointCloud2")
OVERWRITE, MAXIMUM, NOTHING = 0, 1, 99


@dataclass(frozen=True)
class SourceSettings:
    """One sensor; metres and seconds.

    ``observation_persistence``: how long its marks come back after they were cleared, 0 not at all.
    ``expected_update_rate``: seconds after which it counts as dead, 0 never.
    """

    topic: str = ""
    sensor_frame: str = ""
    data_type: str = "PointCloud"
    observation_persistence: float = 0.0
    expected_update_rate: float = 0.0
    min_obstacle_height: float = 0.0
    max_obstacle_height: float = 2.0
    inf_is_valid: bool = False
    marking: bool = True
    clearing: bool = False
    obstacle_range: float = 2.5
    raytrace_range: float = 3.0

    def __post_init__(self):
        check(self.data_type in DATA_TYPES, "data_type", "one of " + ", ".join(DATA_TYPES), self.data_type)
        check(self.obstacle_range > 0.0, "obstacle_range", "positive", self.obstacle_range)
        check(
            self.raytrace_range >= self.obstacle_range or not (self.clearing and self.marking),
            "raytrace_range",
            f"at least obstacle_range ({self.obstacle_range:g}), else marks are never cleared",
            self.raytrace_range,
        )
        for name in ("expected_update_rate", "observation_persistence"):
            check(getattr(self, name) >= 0.0, name, "at least 0", getattr(self, name))


@dataclass(frozen=True)
class ObstacleSettings:
    """The layer and its sensors. ``combination_method``: 0 overwrites the layers below where something is
    known, 1 takes the higher cost, 99 leaves the costmap alone. ``track_unknown_space``: cells not seen yet
    leave what is below as it is; otherwise they make the unknown of a map free."""

    enabled: bool = True
    track_unknown_space: bool = False
    footprint_clearing_enabled: bool = True
    max_obstacle_height: float = 2.0
    combination_method: int = MAXIMUM
    sources: Tuple[SourceSettings, ...] = ()

    def __post_init__(self):
        method = self.combination_method
        check(method in (OVERWRITE, MAXIMUM, NOTHING), "combination_method", "0, 1 or 99", method)


@dataclass(frozen=True, eq=False)
class _Observation:
    """A sighting from where it was made, in the costmap's frame."""

    sighting: Sighting
    sensor_in_frame: Pose2


class ObstacleLayer:
    """Cells that sensors have shown to be occupied or free, aligned with the costmap's window."""

    def __init__(self, settings: ObstacleSettings, rows: int, cols: int):
        self.settings = settings
        self._default = UNKNOWN if settings.track_unknown_space else FREE
        self._kept: Dict[str, List[_Observation]] = {source.topic: [] for source in settings.sources}
        self._new: Dict[str, _Observation] = {}
        self.costs = np.full((rows, cols), self._default, dtype=np.uint8)

    def note(self, sighting: Sighting, base_in_frame: Pose2) -> None:
        """Keeps a sighting until the next update; the newest of a sensor counts."""
        if sighting.topic in self._kept:
            self._new[sighting.topic] = _Observation(sighting, base_in_frame @ sighting.sensor_in_base)

    def update(self, window: Window) -> Bounds:
        """Takes in what was noted: clears for all sensors, then marks.

        Returns the block of cells that may have changed.
        """
        changed = NO_CELLS
        for source in self.settings.sources:
            new = self._new.get(source.topic)
            if new is not None:
                self._integrate(window, source, new, 0.0, source.raytrace_range * source.clearing)
                reach = max(source.obstacle_range, source.raytrace_range) + window.resolution
                seen = window.bounds_around(new.sensor_in_frame.x, new.sensor_in_frame.y, reach)
                changed = union(changed, seen)
        for source in self.settings.sources:
            new = self._new.get(source.topic)
            if new is not None:
                for observation in self._persisting(source, new):
                    self._integrate(window, source, observation, source.obstacle_range * source.marking, 0.0)
        self._new.clear()
        return changed

    def _persisting(self, source: SourceSettings, new: _Observation) -> List[_Observation]:
        """The observations that mark now: the new one, and older ones that still count."""
        oldest = new.sighting.stamp - source.observation_persistence
        kept = [one for one in self._kept[source.topic] if one.sighting.stamp >= oldest]
        self._kept[source.topic] = [*kept, new] if source.observation_persistence > 0.0 else []
        return [*kept, new]

    def _integrate(self, window, source, observation, mark_range: float, clear_range: float) -> None:
        sighting, sensor = observation.sighting, observation.sensor_in_frame
        highest = min(source.max_obstacle_height, self.settings.max_obstacle_height)
        heights = np.broadcast_to(sighting.heights, sighting.ranges.shape)
        at_height = (heights >= source.min_obstacle_height) & (heights <= highest)
        _integrate(
            self.costs,
            (sensor.x - window.origin_x) / window.resolution,
            (sensor.y - window.origin_y) / window.resolution,
            sensor.yaw + sighting.angles[at_height],
            sighting.ranges[at_height],
            sighting.range_min,
            sighting.range_max,
            window.resolution,
            mark_range,
            clear_range,
            source.inf_is_valid,
        )

    def roll(self, rows: int, cols: int) -> None:
        """The window has moved by so many cells: keeps what is still in it."""
        moved = np.full_like(self.costs, self._default)
        height, width = self.costs.shape
        if abs(rows) < height and abs(cols) < width:
            kept = self.costs[max(rows, 0) : height + min(rows, 0), max(cols, 0) : width + min(cols, 0)]
            moved[max(-rows, 0) : height + min(-rows, 0), max(-cols, 0) : width + min(-cols, 0)] = kept
        self.costs = moved

    def clear_footprint(self, window: Window, base_in_frame: Pose2, footprint: Footprint) -> Bounds:
        """Where the robot stands there is no obstacle."""
        return Polygon(base_in_frame.transform_points(footprint.corners_xy)).fill(self.costs, window, FREE)

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
        """Forgets everything."""
        self.costs.fill(self._default)
        for kept in self._kept.values():
            kept.clear()


@numba.njit(cache=True)
def _integrate(
    costs, x, y, angles, ranges, range_min, range_max, resolution, mark_range, clear_range, inf_is_valid
):
    """Clears along all beams, then marks their ends. ``x``, ``y``: the laser, in cells."""
    rows, cols = costs.shape
    for i in range(ranges.size if clear_range > 0.0 else 0):
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
