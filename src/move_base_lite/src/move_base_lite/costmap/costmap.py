"""A costmap in layers: the map, what the laser sees, and inflation over both."""

import math
from dataclasses import dataclass, field
from typing import Optional, Sequence, Tuple

import numba
import numpy as np

from move_base_lite.costmap.costs import FREE, UNKNOWN
from move_base_lite.costmap.footprint import Footprint, collides, contacts, footprint_from
from move_base_lite.costmap.inflation import Inflation, InflationSettings
from move_base_lite.costmap.obstacle_layer import NOTHING, OVERWRITE, ObstacleLayer, ObstacleSettings
from move_base_lite.costmap.polygon import Polygon
from move_base_lite.costmap.sighting import Sighting
from move_base_lite.costmap.static_layer import StaticSettings, static_costs, static_costs_in
from move_base_lite.costmap.window import NO_CELLS, Bounds, Window, union
from move_base_lite.costmap.zone_layer import ZoneLayer
from planar import OccupancyGrid, Pose2
from planar.config.settings import check

# Radians between the headings at which a turn on the spot is checked.
TURN_STEP = 0.1


@dataclass(frozen=True)
class CostmapSettings:
    """One costmap. Lengths in metres, frequencies in Hz; names and defaults of costmap_2d."""

    global_frame: str = "map"
    robot_base_frame: str = "base_link"
    transform_tolerance: float = 0.3
    update_frequency: float = 5.0
    publish_frequency: float = 0.0
    rolling_window: bool = False
    width: float = 10.0
    height: float = 10.0
    resolution: float = 0.05
    origin_x: float = 0.0
    origin_y: float = 0.0
    footprint: Tuple[Tuple[float, float], ...] = ()
    robot_radius: float = 0.46
    footprint_padding: float = 0.01
    track_unknown_space: bool = False
    always_send_full_costmap: bool = False
    static: StaticSettings = field(default_factory=lambda: StaticSettings(enabled=False))
    obstacles: ObstacleSettings = field(default_factory=ObstacleSettings)
    inflation: InflationSettings = field(default_factory=InflationSettings)

    def __post_init__(self):
        for name in ("width", "height", "resolution"):
            check(getattr(self, name) > 0.0, name, "positive", getattr(self, name))
        for name in ("update_frequency", "publish_frequency", "robot_radius", "footprint_padding"):
            check(getattr(self, name) >= 0.0, name, "at least 0", getattr(self, name))
        check(len(self.footprint) not in (1, 2), "footprint", "at least 3 points", self.footprint)


class LayeredCostmap:
    """Costs, uint8 (rows, cols), of the cells of ``window``; fixed to its frame or rolling with the robot.

    Only what can have changed is computed anew: the block that was seen, grown by the inflation radius.
    """

    def __init__(
        self,
        settings: CostmapSettings,
        grid: Optional[OccupancyGrid] = None,
        map_window: Optional[Window] = None,
    ):
        """``map_window``: a size to keep, that of a map whose layer has been switched off since."""
        self.settings = settings
        self.footprint: Footprint = footprint_from(
            settings.footprint, settings.robot_radius, settings.footprint_padding
        )
        self._map_window = map_window or _window_of_map(settings, grid)
        self.window: Window = self._map_window or _window_of(settings)
        self.outline_xy = self.footprint.outline_xy(0.8 * self.window.resolution)
        self._inflation = Inflation(
            settings.inflation, self.footprint.inscribed_radius, self.window.resolution
        )
        rows, cols = self.window.rows, self.window.cols
        self._obstacles: Optional[ObstacleLayer] = None
        if settings.obstacles.enabled:
            self._obstacles = ObstacleLayer(settings.obstacles, rows, cols)
        self._zones = ZoneLayer()
        self._ground = np.full((rows, cols), UNKNOWN if settings.track_unknown_space else FREE, np.uint8)
        self._map = grid
        self._grid = grid if settings.static.enabled else None
        if self._grid is not None:
            self._map_costs = static_costs(self._grid.cells, settings.static)
            if not settings.rolling_window:
                self._ground = self._map_costs
        self._changed = NO_CELLS
        self.costs = np.empty((rows, cols), dtype=np.uint8)
        self.refresh(self.window.everything)
        self.costs_of_map: np.ndarray = self.costs.copy()

    def note(self, sighting: Sighting, base_in_frame: Pose2) -> None:
        """Keeps what a sensor saw from there for the next update."""
        if self._obstacles is not None:
            self._obstacles.note(sighting, base_in_frame)

    def update(self, base_in_frame: Pose2, map_in_frame: Pose2 = Pose2()) -> None:
        """Follows the robot and takes in what has been noted."""
        changed = self._follow(base_in_frame, map_in_frame)
        is_rolling = self.settings.rolling_window
        changed = union(changed, self._zones.update(self.window, map_in_frame, is_rolling))
        if self._obstacles is not None:
            changed = union(changed, self._obstacles.update(self.window))
            if self.settings.obstacles.footprint_clearing_enabled:
                cleared = self._obstacles.clear_footprint(self.window, base_in_frame, self.footprint)
                changed = union(changed, cleared)
        self.refresh(changed)

    def refresh(self, changed: Bounds) -> None:
        """Stacks the layers anew where they have changed."""
        bounds = self.window.grown(changed, self._inflation.reach_cells)
        method = self.settings.obstacles.combination_method
        if self._obstacles is None or method == NOTHING:
            rows, cols = slice(*bounds[:2]), slice(*bounds[2:])
            self.costs[rows, cols] = self._ground[rows, cols]
        else:
            _stack(self.costs, self._ground, self._obstacles.costs, bounds, method == OVERWRITE)
        self._zones.apply(self.costs, bounds)
        self._inflation.apply(self.costs, self.window, bounds)
        self._changed = union(self._changed, bounds)

    def keep_out(self, barred: Sequence[Polygon], disliked: Sequence[Polygon]) -> None:
        """From the next update on, polygons of the map are obstacles, others are only dear to be in."""
        self._zones.set(barred, disliked)

    def changed_to(self, settings: CostmapSettings) -> "LayeredCostmap":
        """This costmap with other settings; it keeps what was seen unless its cells are others."""
        if settings == self.settings:
            return self
        changed = LayeredCostmap(settings, self._map, self._map_window)
        changed._zones = self._zones.anew()
        seen, kept = self._obstacles, changed._obstacles
        if seen is not None and kept is not None and self.window.is_like(changed.window):
            changed.window, kept.costs = self.window, seen.costs
            changed.refresh(changed.window.everything)
        return changed

    def take_changed(self) -> Bounds:
        """The block of cells that may have changed since this was asked last."""
        changed, self._changed = self._changed, NO_CELLS
        return changed

    def collides(self, pose: Pose2) -> bool:
        """Whether the robot's footprint at ``pose`` touches an obstacle, the unknown or the edge."""
        return collides(self.costs, self.window, self.outline_xy, pose)

    def contacts(self, pose: Pose2) -> int:
        """At how many points of its outline the robot at ``pose`` touches something."""
        return contacts(self.costs, self.window, self.outline_xy, pose)

    def has_room_to_turn(self, pose: Pose2, angle: float) -> bool:
        """Whether the robot at ``pose`` can turn so far on the spot without touching more than it does.

        A footprint that is round to within a cell needs no room.
        """
        spread = self.footprint.circumscribed_radius - self.footprint.inscribed_radius
        if spread < self.window.resolution:
            return True
        turns = np.linspace(0.0, angle, math.ceil(abs(angle) / TURN_STEP) + 1)[1:]
        touching = self.contacts(pose)
        return all(self.contacts(pose @ Pose2(0.0, 0.0, float(turn))) <= touching for turn in turns)

    def clear_outside(self, base_in_frame: Pose2, side: float) -> None:
        """Forgets obstacles (not the map) outside a square of ``side`` metres round the robot."""
        if self._obstacles is not None:
            bounds = self.window.bounds_around(base_in_frame.x, base_in_frame.y, 0.5 * side)
            self._obstacles.clear_outside(bounds)
            self.refresh(self.window.everything)

    def clear_around(self, base_in_frame: Pose2, side: float) -> None:
        """Forgets obstacles (not the map) inside a square of ``side`` metres round the robot."""
        if self._obstacles is not None:
            bounds = self.window.bounds_around(base_in_frame.x, base_in_frame.y, 0.5 * side)
            self._obstacles.clear_inside(bounds)
            self.refresh(bounds)

    def reset(self) -> None:
        """Forgets all that was seen; the map stays."""
        if self._obstacles is not None:
            self._obstacles.reset()
            self.refresh(self.window.everything)

    def _follow(self, base_in_frame: Pose2, map_in_frame: Pose2) -> Bounds:
        if not self.settings.rolling_window:
            return NO_CELLS
        before, self.window = self.window, self.window.centred_on(base_in_frame.x, base_in_frame.y)
        cols = round((self.window.origin_x - before.origin_x) / self.window.resolution)
        rows = round((self.window.origin_y - before.origin_y) / self.window.resolution)
        if (rows or cols) and self._obstacles is not None:
            self._obstacles.roll(rows, cols)
        if self._grid is not None:
            self._ground = static_costs_in(self.window, map_in_frame.inverse(), self._grid, self._map_costs)
        return self.window.everything


def _window_of_map(settings: CostmapSettings, grid: Optional[OccupancyGrid]) -> Optional[Window]:
    if not settings.static.enabled or grid is None or settings.rolling_window:
        return None
    return Window(grid.rows, grid.cols, grid.resolution, grid.origin.x, grid.origin.y)


def _window_of(settings: CostmapSettings) -> Window:
    rows, cols = round(settings.height / settings.resolution), round(settings.width / settings.resolution)
    return Window(rows, cols, settings.resolution, settings.origin_x, settings.origin_y)


@numba.njit(cache=True)
def _stack(costs, ground, obstacles, bounds, overwrite):
    """The higher of both layers, or the upper; the unknown of one gives way to the knowledge of the other."""
    row_min, row_max, col_min, col_max = bounds
    for row in range(row_min, row_max):
        for col in range(col_min, col_max):
            below, above = ground[row, col], obstacles[row, col]
            if above == UNKNOWN:
                costs[row, col] = below
            elif overwrite or below == UNKNOWN:
                costs[row, col] = above
            else:
                costs[row, col] = max(below, above)
