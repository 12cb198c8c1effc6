"""A costmap in layers: the map, what sensors see, zones, and inflation over all."""

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

# Radians between the headings at which a turn on the spot is checked.
TURN_STEP = 0.1


class LayeredCostmap:
    """Costs, uint8 (rows, cols), of the cells of ``window``; fixed to its frame or rolling with the robot.

    Only what can have changed is computed anew: the block that was seen, grown by what inflation reaches.
    """

    def __init__(
        self,
        settings: CostmapSettings,
        grid: Optional[OccupancyGrid] = None,
        map_window: Optional[CostmapWindow] = None,
    ):
        """``map_window``: a size to keep, that of a map whose layer has been switched off since."""
        self.settings = settings
        self.footprint: Footprint = footprint_from(
            settings.footprint, settings.robot_radius, settings.footprint_padding
        )
        self._map = grid
        self._map_window = map_window or _window_of_map(settings, grid)
        self.window: CostmapWindow = self._map_window or _window_of(settings)
        self.outline_xy = self.footprint.outline_xy(0.8 * self.window.resolution)
        context = LayerContext(self.window, settings.rolling_window, self.footprint, grid)
        self._zones = ZoneLayer(LayerSettings(), context)
        obstacles, own = _made([settings.obstacles], context), _made(settings.plugin_layers, context)
        ground, inflation = _made([settings.static], context), _made([settings.inflation], context)
        self._layers = [*ground, *obstacles, self._zones, *own, *inflation]
        self._remembering = [*obstacles, *own]
        self._reach_cells = sum(layer.reach_cells for layer in self._layers)
        self._unseen = UNKNOWN if settings.track_unknown_space else FREE
        self._changed = NO_CELLS
        self.costs = np.empty((self.window.rows, self.window.cols), dtype=np.uint8)
        self.recompute(self.window.everything)
        self.map_costs: np.ndarray = self.costs.copy()

    def add_observation(self, observation: Observation, base_in_frame: Pose2) -> None:
        """Keeps what a sensor saw from there for the next update."""
        for layer in self._layers:
            layer.add_observation(observation, base_in_frame)

    def update(self, base_in_frame: Pose2, map_in_frame: Pose2 = Pose2()) -> None:
        """Follows the robot and takes in what has been noted."""
        placement = self._follow(base_in_frame, map_in_frame)
        changed = self.window.everything if self.settings.rolling_window else NO_CELLS
        for layer in self._layers:
            changed = union(changed, layer.update(placement))
        self.recompute(changed)

    def recompute(self, changed: CellBounds) -> None:
        """Stacks the layers anew where they have changed."""
        bounds = self.window.grown(changed, self._reach_cells)
        self.costs[bounds.slices] = self._unseen
        for layer in self._layers:
            layer.apply(self.costs, self.window, bounds)
        self._changed = union(self._changed, bounds)

    def set_keep_out(self, barred: Sequence[Polygon], disliked: Sequence[Polygon]) -> None:
        """From the next update on, polygons of the map are obstacles, others are only dear to be in."""
        self._zones.set(barred, disliked)

    def with_settings(self, settings: CostmapSettings) -> "LayeredCostmap":
        """This costmap with other settings; it keeps what was seen unless its cells are others."""
        if settings == self.settings:
            return self
        changed = LayeredCostmap(settings, self._map, self._map_window)
        changed._zones.take_over(self._zones)
        if self.window.is_like(changed.window):
            changed._remember(self)
        return changed

    def _remember(self, before: "LayeredCostmap") -> None:
        """Goes on with what the same layers of a costmap of as many cells have known."""
        known = {layer.kind: layer for layer in before._remembering}
        pairs = [(layer, known[layer.kind]) for layer in self._remembering if layer.kind in known]
        for layer, same in pairs:
            layer.take_over(same)
        if pairs:
            self.window = before.window
            self.recompute(self.window.everything)

    def pop_changed_bounds(self) -> CellBounds:
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
        bounds = self.window.bounds_around(base_in_frame.x, base_in_frame.y, 0.5 * side)
        self._refresh_changed([layer.clear_outside(bounds, self.window) for layer in self._layers])

    def clear_around(self, base_in_frame: Pose2, side: float) -> None:
        """Forgets obstacles (not the map) inside a square of ``side`` metres round the robot."""
        bounds = self.window.bounds_around(base_in_frame.x, base_in_frame.y, 0.5 * side)
        self._refresh_changed([layer.clear_inside(bounds) for layer in self._layers])

    def reset(self) -> None:
        """Forgets all that was seen; the map stays."""
        self._refresh_changed([layer.clear_outside(NO_CELLS, self.window) for layer in self._layers])

    def _refresh_changed(self, blocks: Sequence[CellBounds]) -> None:
        changed = NO_CELLS
        for block in blocks:
            changed = union(changed, block)
        if changed != NO_CELLS:
            self.recompute(changed)

    def _follow(self, base_in_frame: Pose2, map_in_frame: Pose2) -> CostmapPlacement:
        """Moves the window, if it rolls."""
        if not self.settings.rolling_window:
            return CostmapPlacement(self.window, 0, 0, base_in_frame, map_in_frame)
        before, self.window = self.window, self.window.centred_on(base_in_frame.x, base_in_frame.y)
        cols = round((self.window.origin_x - before.origin_x) / self.window.resolution)
        rows = round((self.window.origin_y - before.origin_y) / self.window.resolution)
        return CostmapPlacement(self.window, rows, cols, base_in_frame, map_in_frame)


def _made(settings: Sequence[LayerSettings], context: LayerContext) -> List[Layer]:
    return [LAYERS.make(each, context) for each in settings if each.enabled]


def _window_of_map(settings: CostmapSettings, grid: Optional[OccupancyGrid]) -> Optional[CostmapWindow]:
    if not settings.static.enabled or grid is None or settings.rolling_window:
        return None
    return CostmapWindow(grid.rows, grid.cols, grid.resolution, grid.origin.x, grid.origin.y)


def _window_of(settings: CostmapSettings) -> CostmapWindow:
    rows, cols = round(settings.height / settings.resolution), round(settings.width / settings.resolution)
    return CostmapWindow(rows, cols, settings.resolution, settings.origin_x, settings.origin_y)
