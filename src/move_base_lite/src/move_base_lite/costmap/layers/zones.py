"""Zones drawn into the map, as a layer over all others."""

from typing import Sequence

import numpy as np

from move_base_lite.costmap.costs import INSCRIBED, LETHAL
from move_base_lite.costmap.layer import CostmapPlacement, Layer, LayerContext, LayerSettings
from move_base_lite.costmap.polygon import Polygon
from move_base_lite.costmap.window import NO_CELLS, CellBounds, CostmapWindow

# Cost of a cell that the robot can cross but is to get out of.
DISLIKED = INSCRIBED - 1


class ZoneLayer(Layer):
    """Raises the costs of the cells of polygons, which are given in the map; it is in every costmap."""

    def __init__(self, settings: LayerSettings, context: LayerContext):
        self._is_rolling = context.is_rolling
        self._barred: Sequence[Polygon] = ()
        self._disliked: Sequence[Polygon] = ()
        self._is_new = False
        self._costs = np.zeros((0, 0), np.uint8)

    def set(self, barred: Sequence[Polygon], disliked: Sequence[Polygon]) -> None:
        """From the next update on the ``barred`` ones are obstacles, the ``disliked`` ones dear to be in."""
        self._barred, self._disliked = barred, disliked
        self._is_new = True

    def take_over(self, before: Layer) -> None:
        assert isinstance(before, ZoneLayer)
        self.set(before._barred, before._disliked)

    def update(self, placement: CostmapPlacement) -> CellBounds:
        """Draws the polygons anew if they or the window may have changed."""
        is_anywhere = bool(self._barred or self._disliked)
        if not (self._is_new or (self._is_rolling and is_anywhere)):
            return NO_CELLS
        self._is_new = False
        window = placement.window
        self._costs = np.zeros((window.rows, window.cols), np.uint8)
        for polygons, cost in ((self._disliked, DISLIKED), (self._barred, LETHAL)):
            for polygon in polygons:
                polygon.in_frame(placement.map_in_frame).fill(self._costs, window, cost)
        return window.everything

    def apply(self, costs: np.ndarray, window: CostmapWindow, bounds: CellBounds) -> None:
        """Raises the costs; the unknown stays so where it is only disliked."""
        if self._costs.size:
            rows, cols = bounds.slices
            below, above = costs[rows, cols], self._costs[rows, cols]
            np.maximum(below, above, out=below)
            below[above == LETHAL] = LETHAL
