"""Zone layer: keep-out zones as obstacles (Nav2: KeepoutFilter)."""

from typing import Sequence

import numpy as np

from move_base_lite.costmap.costs import INSCRIBED, LETHAL
from move_base_lite.costmap.layer import CostmapPlacement, Layer, LayerContext, LayerSettings
from move_base_lite.costmap.polygon import Polygon
from move_base_lite.costmap.window import NO_CELLS, CellBounds, CostmapWindow

# Cost in a keep-out zone that the robot is in: it can cross the cells, but planners prefer to leave them.
OCCUPIED_ZONE_COST = INSCRIBED - 1


class ZoneLayer(Layer):
    """Raises the costs in polygons of the map; part of every costmap."""

    def __init__(self, settings: LayerSettings, context: LayerContext):
        self._is_rolling = context.is_rolling
        self._blocked: Sequence[Polygon] = ()
        self._occupied: Sequence[Polygon] = ()
        self._has_changed = False
        self._costs = np.zeros((0, 0), np.uint8)

    def set_zones(self, blocked: Sequence[Polygon], occupied: Sequence[Polygon]) -> None:
        """Set the zones, from the next update on.

        Args:
            blocked: Polygons of the map that are obstacles.
            occupied: Polygons that the robot is in and has to leave.
        """
        self._blocked, self._occupied = blocked, occupied
        self._has_changed = True

    def take_over(self, before: Layer) -> None:
        assert isinstance(before, ZoneLayer)
        self.set_zones(before._blocked, before._occupied)

    def update(self, placement: CostmapPlacement) -> CellBounds:
        """Draw the polygons again if they or the window may have changed (see Layer.update)."""
        has_zones = bool(self._blocked or self._occupied)
        if not (self._has_changed or (self._is_rolling and has_zones)):
            return NO_CELLS
        self._has_changed = False
        window = placement.window
        self._costs = np.zeros((window.rows, window.cols), np.uint8)
        for polygons, cost in ((self._occupied, OCCUPIED_ZONE_COST), (self._blocked, LETHAL)):
            for polygon in polygons:
                polygon.in_frame(placement.map_in_frame).fill(self._costs, window, cost)
        return window.everything

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds: CellBounds) -> None:
        """Raise the costs; in zones that the robot is in, unknown cells stay unknown (see Layer.apply)."""
        if self._costs.size:
            rows, cols = bounds.slices
            below, above = costs[rows, cols], self._costs[rows, cols]
            np.maximum(below, above, out=below)
            below[above == LETHAL] = LETHAL
