"""Layered costmap: static map, obstacles, zones, plugin layers and inflation (costmap_2d)."""

import math
from typing import List, Optional, Sequence

import numpy as np

from move_base_lite.costmap.costs import FREE, UNKNOWN
from move_base_lite.costmap.footprint import Footprint, collides, contacts, footprint_from
from move_base_lite.costmap.layer import CostmapPlacement, Layer, LayerContext, LayerSettings
from move_base_lite.costmap.layers.zones import ZoneLayer
from move_base_lite.costmap.observation import Observation
from move_base_lite.costmap.polygon import Polygon
from move_base_lite.costmap.registry import LAYERS
from move_base_lite.costmap.settings import CostmapSettings
from move_base_lite.costmap.window import NO_CELLS, CellBounds, CostmapWindow, union
from planar import OccupancyGrid, Pose2

# Radians between the headings at which a rotation in place is checked for collisions.
TURN_STEP = 0.1


class LayeredCostmap:
    """Costmap that is fixed in its frame or rolls with the robot.

    An update recomputes only the cells that may have changed: the observed block, grown by the reach of
    inflation.

    Attributes:
        settings: Parameters of the costmap and its layers.
        footprint: Outline of the robot.
        window: Position of the cells.
        outline_xy: (N, 2) points of the footprint at which collisions are checked, in the base frame [m].
        costs: Costs, uint8 (rows, cols).
        map_costs: Costs without observations, uint8 (rows, cols).
    """

    def __init__(
        self,
        settings: CostmapSettings,
        grid: Optional[OccupancyGrid] = None,
        map_window: Optional[CostmapWindow] = None,
    ):
        """Create a costmap without observations.

        Args:
            settings: Parameters of the costmap and its layers.
            grid: Static map, if there is one.
            map_window: Window of the static map; keeps its size if the static layer has been disabled since.
        """
        self.settings = settings
        self.footprint: Footprint = footprint_from(
            settings.footprint, settings.robot_radius, settings.footprint_padding
        )
        grid = None if grid is None else grid.axis_aligned()
        self._map = grid
        self._map_window = map_window or _window_of_map(settings, grid)
        self.window: CostmapWindow = self._map_window or _window_of(settings)
        self.outline_xy = self.footprint.outline_xy(0.8 * self.window.resolution)
        context = LayerContext(self.window, settings.rolling_window, self.footprint, grid)
        self._zones = ZoneLayer(LayerSettings(), context)
        obstacles = _enabled_layers([settings.obstacles], context)
        plugins = _enabled_layers(settings.plugin_layers, context)
        static = _enabled_layers([settings.static], context)
        inflation = _enabled_layers([settings.inflation], context)
        self._layers = [*static, *obstacles, self._zones, *plugins, *inflation]
        self._observing = [*obstacles, *plugins]
        self._reach_cells = sum(layer.reach_cells for layer in self._layers)
        self._default = UNKNOWN if settings.track_unknown_space else FREE
        self._changed = NO_CELLS
        self.costs = np.empty((self.window.rows, self.window.cols), dtype=np.uint8)
        self.recompute(self.window.everything)
        self.map_costs: np.ndarray = self.costs.copy()

    def add_observation(self, observation: Observation, base_in_frame: Pose2) -> None:
        """Store sensor data for the next update.

        Args:
            observation: Beams of one sensor.
            base_in_frame: Robot in the costmap's frame when they were measured.
        """
        for layer in self._layers:
            layer.add_observation(observation, base_in_frame)

    def update(self, base_in_frame: Pose2, map_in_frame: Pose2 = Pose2()) -> None:
        """Follow the robot and integrate the stored observations.

        Args:
            base_in_frame: Robot in the costmap's frame.
            map_in_frame: Map in the costmap's frame.
        """
        placement = self._follow(base_in_frame, map_in_frame)
        changed = self.window.everything if self.settings.rolling_window else NO_CELLS
        for layer in self._layers:
            changed = union(changed, layer.update(placement))
        self.recompute(changed)

    def recompute(self, changed: CellBounds) -> None:
        """Apply all layers again.

        Args:
            changed: Block of cells that have changed; it is grown by the reach of inflation.
        """
        bounds = self.window.grown(changed, self._reach_cells)
        self.costs[bounds.slices] = self._default
        for layer in self._layers:
            layer.apply(self.costs, self.window, bounds)
        self._changed = union(self._changed, bounds)

    def set_keep_out(self, blocked: Sequence[Polygon], occupied: Sequence[Polygon]) -> None:
        """Set the keep-out zones, from the next update on.

        Args:
            blocked: Polygons of the map that become obstacles.
            occupied: Polygons that the robot is in and has to leave: expensive, but not blocked.
        """
        self._zones.set_zones(blocked, occupied)

    def with_settings(self, settings: CostmapSettings) -> "LayeredCostmap":
        """Return a costmap with other settings.

        Args:
            settings: Parameters of the costmap and its layers.

        Returns:
            The costmap, with the observations of this one unless the size changes; this one if nothing
            changes.
        """
        if settings == self.settings:
            return self
        changed = LayeredCostmap(settings, self._map, self._map_window)
        changed._zones.take_over(self._zones)
        if self.window.has_same_size(changed.window):
            changed._take_over_layers(self)
        return changed

    def _take_over_layers(self, before: "LayeredCostmap") -> None:
        """Take over the state of the layers of a costmap of the same size."""
        replaced = {layer.kind: layer for layer in before._observing}
        pairs = [(layer, replaced[layer.kind]) for layer in self._observing if layer.kind in replaced]
        for layer, old in pairs:
            layer.take_over(old)
        if pairs:
            self.window = before.window
            self.recompute(self.window.everything)

    def pop_changed_bounds(self) -> CellBounds:
        """Return the block of cells that may have changed since the last call."""
        changed, self._changed = self._changed, NO_CELLS
        return changed

    def collides(self, pose: Pose2) -> bool:
        """Check whether the footprint touches an obstacle, unknown space or the edge of the costmap.

        Args:
            pose: Pose of the base in the costmap's frame.
        """
        return collides(self.costs, self.window, self.outline_xy, pose)

    def contacts(self, pose: Pose2) -> int:
        """Count the points of the footprint that collide.

        Args:
            pose: Pose of the base in the costmap's frame.
        """
        return contacts(self.costs, self.window, self.outline_xy, pose)

    def has_room_to_turn(self, pose: Pose2, angle: float) -> bool:
        """Check whether the robot can rotate in place without touching more than it does now.

        A footprint that is round to within one cell always can.

        Args:
            pose: Pose of the base in the costmap's frame.
            angle: Rotation [rad].
        """
        spread = self.footprint.circumscribed_radius - self.footprint.inscribed_radius
        if spread < self.window.resolution:
            return True
        turns = np.linspace(0.0, angle, math.ceil(abs(angle) / TURN_STEP) + 1)[1:]
        touching = self.contacts(pose)
        return all(self.contacts(pose @ Pose2(0.0, 0.0, float(turn))) <= touching for turn in turns)

    def clear_outside(self, base_in_frame: Pose2, side: float) -> None:
        """Clear obstacles (not the map) outside of a square around the robot.

        Args:
            base_in_frame: Robot pose in the costmap's frame.
            side: Side of the square [m].
        """
        bounds = self.window.bounds_around(base_in_frame.x, base_in_frame.y, 0.5 * side)
        self._recompute_blocks([layer.clear_outside(bounds, self.window) for layer in self._layers])

    def clear_around(self, base_in_frame: Pose2, side: float) -> None:
        """Clear obstacles (not the map) inside a square around the robot.

        Args:
            base_in_frame: Robot pose in the costmap's frame.
            side: Side of the square [m].
        """
        bounds = self.window.bounds_around(base_in_frame.x, base_in_frame.y, 0.5 * side)
        self._recompute_blocks([layer.clear_inside(bounds) for layer in self._layers])

    def reset(self) -> None:
        """Clear all observations; the map stays."""
        self._recompute_blocks([layer.clear_outside(NO_CELLS, self.window) for layer in self._layers])

    def _recompute_blocks(self, blocks: Sequence[CellBounds]) -> None:
        changed = NO_CELLS
        for block in blocks:
            changed = union(changed, block)
        if changed != NO_CELLS:
            self.recompute(changed)

    def _follow(self, base_in_frame: Pose2, map_in_frame: Pose2) -> CostmapPlacement:
        """Move a rolling window with the robot."""
        if not self.settings.rolling_window:
            return CostmapPlacement(self.window, 0, 0, base_in_frame, map_in_frame)
        before, self.window = self.window, self.window.centred_on(base_in_frame.x, base_in_frame.y)
        cols = round((self.window.origin_x - before.origin_x) / self.window.resolution)
        rows = round((self.window.origin_y - before.origin_y) / self.window.resolution)
        return CostmapPlacement(self.window, rows, cols, base_in_frame, map_in_frame)


def _enabled_layers(settings: Sequence[LayerSettings], context: LayerContext) -> List[Layer]:
    return [LAYERS.make(each, context) for each in settings if each.enabled]


def _window_of_map(settings: CostmapSettings, grid: Optional[OccupancyGrid]) -> Optional[CostmapWindow]:
    if not settings.static.enabled or grid is None or settings.rolling_window:
        return None
    return CostmapWindow(grid.rows, grid.cols, grid.resolution, grid.origin.x, grid.origin.y)


def _window_of(settings: CostmapSettings) -> CostmapWindow:
    rows, cols = round(settings.height / settings.resolution), round(settings.width / settings.resolution)
    return CostmapWindow(rows, cols, settings.resolution, settings.origin_x, settings.origin_y)
